// From a ladder to a glTF file. The original's document is copied and only added to; what it cannot keep (compressed
// geometry that is to come out plain, other files) is replaced in place, so that every index in it still means the
// same.
#include "lodestone/io/gltf/write.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <new>
#include <optional>
#include <set>
#include <span>

#include "lodestone/base/file.h"
#include "lodestone/base/units.h"
#include "lodestone/core/validate.h"
#include "lodestone/io/draco_detail.h"
#include "lodestone/io/gltf/document.h"
#include "lodestone/io/gltf/fresh_detail.h"
#include "lodestone/io/gltf/geometry_detail.h"
#include "lodestone/io/gltf/lod_detail.h"
#include "lodestone/io/gltf/meshopt_detail.h"
#include "lodestone/io/gltf/names_detail.h"
#include "lodestone/io/gltf/repair_detail.h"
#include "lodestone/io/gltf/uri_detail.h"
#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

namespace {

std::string_view as_text(ByteSpan bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

// All that writing one file needs.
struct Writer {
  const Model& original;
  std::span<const Level> levels;  // [0] stands for the original
  const WriteOptions& options;
  const Document::Data* document;  // null: from another format
  Json json;
  std::optional<GltfPack> pack;
  WriteReport report;
  std::vector<std::size_t> instance_nodes;
  std::vector<Json> source_meshes;  // as the document had them
  std::vector<bool> rewritten;      // meshes whose level 0 is written anew
};

// A level's mesh that lies elsewhere in its node than the original's: by another transform or offset.
bool is_moved(const Model& original, const Model& level, std::size_t instance) {
  const Instance &then = original.instances[instance], &now = level.instances[instance];
  return then.transform != now.transform || original.meshes[then.mesh].offset != level.meshes[now.mesh].offset;
}

// From the original's place there is a way to the level's, but from a flattened one to no other.
bool can_be_placed(const Instance& original, const Instance& level) {
  return original.transform == level.transform || std::abs(original.transform.determinant3()) > 0;
}

// Nodes of a document have children, skins and animations: its levels must lie in them as the original does.
Result<void> check_placing(const Model& original, const Model& level, std::size_t number) {
  if (level.meshes.size() != original.meshes.size() || level.instances.size() != original.instances.size()) {
    return fail(
        ErrorCode::bad_argument,
        fmt::format("level {} has {} meshes drawn {} times, the original {} drawn {} times", number,
                    level.meshes.size(), level.instances.size(), original.meshes.size(), original.instances.size()));
  }
  for (std::size_t i = 0; i < original.instances.size(); ++i) {
    const bool same_mesh = level.instances[i].mesh == original.instances[i].mesh;
    const bool may_move = original.document == nullptr && can_be_placed(original.instances[i], level.instances[i]);
    if (same_mesh && (may_move || !is_moved(original, level, i))) continue;
    return fail(ErrorCode::bad_argument,
                fmt::format("instance {} of level {} is placed otherwise than the original's", i, number), {},
                "give it the original's mesh, transform and Mesh::offset");
  }
  return {};
}

Result<void> check(const Model& original, std::span<const Level> levels, const std::filesystem::path& path,
                   Compression compression) {
  for (std::size_t level = 1; level < levels.size(); ++level) {
    Result<void> ok = check_placing(original, levels[level].model, level);
    if (!ok) return fail(ok.error().code, ok.error().what, path.string(), ok.error().remedy);
  }
  const bool missing =
      (compression == Compression::meshopt && !has_meshopt()) || (compression == Compression::draco && !has_draco());
  if (missing) {
    return fail(ErrorCode::unsupported, "this build was made without that compression", path.string(),
                "build with LODESTONE_WITH_MESHOPT and LODESTONE_WITH_DRACO, or leave `compression` off");
  }
  return {};
}

bool has_draco_primitive(const Json& mesh) {
  for (const Json& p : array_member(mesh, "primitives")) {
    if (is_draco_primitive(p) && is_triangle_primitive(p)) return true;
  }
  return false;
}

// Meshes whose level 0 cannot keep the document's own accessors. One that never had a triangle stays as it is.
std::vector<bool> find_rewritten(const Writer& w) {
  const std::vector<Mesh>& meshes = w.original.meshes;
  std::vector<bool> out(meshes.size(), true);
  for (std::size_t m = 0; w.document != nullptr && m < meshes.size(); ++m) {
    const bool changed = w.document->fingerprints[m] != fingerprint(meshes[m]);
    const bool coded = w.options.compression != Compression::none || has_draco_primitive(w.source_meshes[m]);
    out[m] = changed || (coded && !meshes[m].triangles.empty());
  }
  return out;
}

// Every view of the document that is still needed gets its bytes in the new binary chunk.
void keep_views(Writer& w, const MendedViews& mended) {
  const std::vector<bool> released = release_views(*w.document, w.rewritten, w.json);
  for (std::size_t i = 0; i < w.document->views.size(); ++i) {
    if (released[i]) {
      w.pack->free_view(i);
    } else {
      const auto better = mended.find(i);
      w.pack->set_view(i, 0, better != mended.end() ? better->second : as_text(w.document->views[i].bytes));
    }
  }
}

// Images in files of their own come along in the binary chunk.
void keep_images(Writer& w) {
  for (const ExternalImage& image : w.document->images) {
    Json& json = w.json["images"][image.image];
    if (image.mime.empty()) {
      w.report.warnings.push_back(fmt::format("image {} is of an unknown kind: still a file of its own", image.image));
      continue;
    }
    json.erase("uri");
    json["bufferView"] = w.pack->add_bytes(0, as_text(image.bytes));
    json["mimeType"] = image.mime;
  }
}

// A transform that is no move, turn and scale stays, as anything else would draw another model.
void tell_odd_transforms(Writer& w) {
  constexpr std::size_t kTold = 3;
  std::size_t found = 0;
  const Json& nodes = array_member(w.json, "nodes");
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (!has_odd_transform(nodes[n]) || ++found > kTold) continue;
    w.report.warnings.push_back(
        fmt::format("node {} has a transform that glTF does not allow (a rotation that is no unit quaternion, or a "
                    "matrix that shears or flattens): kept as it is",
                    n));
  }
  if (found <= kTold) return;
  const std::size_t others = found - kTold;
  w.report.warnings.push_back(
      fmt::format("{} other node{} such transforms: kept as they are", others, others == 1 ? " has" : "s have"));
}

void begin_from_document(Writer& w) {
  w.json = w.document->json;
  repair_names(w.json, w.report.warnings);
  repair_weights(w.json);
  tell_odd_transforms(w);
  w.instance_nodes = w.document->instance_nodes;
  for (const Json& mesh : array_member(w.json, "meshes")) w.source_meshes.push_back(mesh);
  w.pack.emplace(w.json, w.options.compression, w.levels.size());
  w.rewritten = find_rewritten(w);
  const MendedViews mended = mend_values(*w.document, w.rewritten, w.report.warnings);
  repair_accessors(*w.document, mended, w.json);
  keep_views(w, mended);
  keep_images(w);
  std::set<std::string> gone{kDraco, kMeshoptNames[0], kMeshoptNames[1]};
  for (const std::string& name : w.pack->moved_extensions()) {
    if (!gone.insert(name).second) continue;
    w.report.warnings.push_back(
        fmt::format("{} said where bytes of the file lay, and they have moved: left out", name));
  }
  for (const std::string& name : gone) {
    for (const char* key : {"extensionsUsed", "extensionsRequired"}) unlist_extension(w.json, key, name);
  }
}

void begin_fresh(Writer& w) {
  const Model& original = w.original;
  w.json = make_fresh_document(original);
  for (std::size_t i = 0; i < original.instances.size(); ++i) w.instance_nodes.push_back(i);
  for (const Json& mesh : w.json["meshes"]) w.source_meshes.push_back(mesh);
  w.pack.emplace(w.json, w.options.compression, w.levels.size());
  w.rewritten = find_rewritten(w);
  add_fresh_materials(original, w.json, *w.pack, w.report.warnings);
}

// The primitives of mesh `index` with the geometry of `mesh`; points and lines stay as they are.
Json pack_primitives(Writer& w, std::size_t level, const Mesh& mesh, std::size_t index) {
  const bool flip_v = w.document == nullptr && !w.original.uv_origin_top;
  const Json* named = w.document != nullptr ? &array_member(w.document->json, "meshes")[index] : nullptr;
  const std::vector<AttributePlan> plans = plan_attributes(mesh, named, flip_v, w.report.warnings);
  GroupIndexer groups(mesh);
  Json out = Json::array();
  std::size_t group = 0;
  // Without a document each level says by itself which materials it has: one made anew may have others.
  const Json own =
      w.document == nullptr ? fresh_primitives(mesh, array_member(w.json, "materials").size()) : Json::array();
  for (const Json& source : w.document == nullptr ? own : array_member(w.source_meshes[index], "primitives")) {
    if (!is_triangle_primitive(source)) {
      out.push_back(source);
      continue;
    }
    Json primitive = pack_primitive(*w.pack, level, mesh, groups.of(group++), plans, source, w.report.warnings);
    if (primitive.is_null()) continue;
    if (w.document == nullptr) use_untextured_material(w.json, primitive);
    out.push_back(std::move(primitive));
  }
  return out;
}

bool names(const Json& object, const char* key, std::size_t index) {
  const Json* value = member(object, key);
  return value != nullptr && as_uint(*value) == std::optional<std::uint64_t>(index);
}

// A mesh of which nothing is left: no node draws it any more. It keeps its index, and a point that takes no bytes.
void retire_mesh(Json& json, std::size_t mesh) {
  json["accessors"].push_back(
      {{"componentType", 5126}, {"count", 1}, {"type", "VEC3"}, {"min", {0, 0, 0}}, {"max", {0, 0, 0}}});
  const std::size_t accessor = json["accessors"].size() - 1;
  json["meshes"][mesh]["primitives"] = Json::array({{{"attributes", {{"POSITION", accessor}}}, {"mode", 0}}});
  json["meshes"][mesh].erase("weights");
  for (std::size_t n = 0; n < json["nodes"].size(); ++n) {
    Json& node = json["nodes"][n];
    if (!names(node, "mesh", mesh)) continue;
    for (const char* key : {"mesh", "skin", "weights"}) node.erase(key);
    if (node.contains("extensions") && node["extensions"].erase(kInstancing) > 0 && node["extensions"].empty()) {
      node.erase("extensions");
    }
    detach_weight_channels(json, n);
  }
}

// Level 0: the document's own accessors where they can stay.
Result<void> write_original_meshes(Writer& w, const Task& task) {
  const std::vector<Mesh>& meshes = w.original.meshes;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    if (task.cancelled()) return cancelled_error("writing");
    if (!w.rewritten[m]) continue;
    Json primitives = pack_primitives(w, 0, meshes[m], m);
    drop_geometry_extensions(w.json["meshes"][m], w.report.warnings);
    if (primitives.empty()) {
      retire_mesh(w.json, m);
    } else {
      w.json["meshes"][m]["primitives"] = std::move(primitives);
    }
  }
  return {};
}

// The JSON mesh of each mesh at a level: kNone where nothing is left.
Result<std::vector<std::size_t>> write_level_meshes(Writer& w, std::size_t level, const Task& task) {
  const std::vector<Mesh>& meshes = w.levels[level].model.meshes;
  const std::vector<std::uint32_t> uses = instance_counts(w.original);
  std::vector<std::size_t> out(meshes.size(), kNone);
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    if (uses[m] == 0) continue;
    if (task.cancelled()) return cancelled_error("writing");
    Json primitives = pack_primitives(w, level, meshes[m], m);
    if (primitives.empty()) continue;
    Json mesh = w.source_meshes[m];
    const std::string name = string_member(mesh, "name");
    if (!name.empty()) mesh["name"] = fmt::format("{}_LOD{}", name, level);
    drop_geometry_extensions(mesh, w.report.warnings);
    mesh["primitives"] = std::move(primitives);
    out[m] = w.json["meshes"].size();
    w.json["meshes"].push_back(std::move(mesh));
  }
  return out;
}

// Where a level lies as seen from the node of the original.
Mat4d seen_from(const Model& original, const Model& level, std::size_t instance) {
  const Instance &then = original.instances[instance], &now = level.instances[instance];
  const Vec3d from = original.meshes[then.mesh].offset, to = level.meshes[now.mesh].offset;
  if (then.transform == now.transform) return Mat4d::translation(to - from);
  const Mat4d base = fresh_placing(original, instance);
  const Mat4d back = base.inverse3() * Mat4d::translation({-base.m[12], -base.m[13], -base.m[14]});
  return back * fresh_placing(level, instance);
}

// A new surface may have an offset of its own, which is the node's part; a leaf lies in its original's node already.
void place_moved_levels(Writer& w, std::size_t instance, const NodeLevels& nodes) {
  const bool inside = nodes.holder != w.instance_nodes[instance];
  for (std::size_t k = 0; w.document == nullptr && k < nodes.levels.size(); ++k) {
    const Model& level = w.levels[k + 1].model;
    if (!is_moved(w.original, level, instance)) continue;
    place_fresh_node(w.json["nodes"][nodes.levels[k]],
                     inside ? seen_from(w.original, level, instance) : fresh_placing(level, instance));
  }
}

Result<void> write_levels(Writer& w, const Task& task) {
  const std::size_t levels = w.levels.size();
  std::vector<std::vector<std::size_t>> meshes;  // level - 1, mesh
  for (std::size_t level = 1; level < levels; ++level) {
    Result<std::vector<std::size_t>> one = write_level_meshes(w, level, task);
    LODESTONE_TRY(one);
    meshes.push_back(std::move(*one));
    task.advance(1.0 / static_cast<double>(levels));
  }
  if (levels < 2) return {};
  std::vector<bool> served(w.json["nodes"].size(), false);
  for (std::size_t i = 0; i < w.original.instances.size(); ++i) {
    const std::size_t node = w.instance_nodes[i];
    if (served[node]) continue;  // several instances of one node: EXT_mesh_gpu_instancing
    served[node] = true;
    std::vector<std::size_t> of_node;
    for (const auto& level : meshes) of_node.push_back(level[w.original.instances[i].mesh]);
    const bool told = i < w.options.screen_coverage.size();
    const NodeLevels nodes = add_node_levels(
        w.json, node, of_node, told ? w.options.screen_coverage[i] : std::vector<double>{}, w.report.warnings);
    place_moved_levels(w, i, nodes);
  }
  list_extension(w.json, "extensionsUsed", kMsftLod);
  return {};
}

void list_draco(Json& json) {
  for (const Json& mesh : array_member(json, "meshes")) {
    for (const Json& primitive : array_member(mesh, "primitives")) {
      if (!is_draco_primitive(primitive)) continue;
      list_extension(json, "extensionsUsed", kDraco);
      list_extension(json, "extensionsRequired", kDraco);
      return;
    }
  }
}

// Names from other formats may be no UTF-8: what isn't becomes U+FFFD.
std::string dump(const Json& json, int indent) { return json.dump(indent, ' ', false, Json::error_handler_t::replace); }

void put_u32(std::string& out, std::size_t value) {
  const auto v = static_cast<std::uint32_t>(value);
  out.append(reinterpret_cast<const char*>(&v), 4);
}

Result<void> write_glb(Writer& w, const std::filesystem::path& path, const std::string& bin) {
  std::string text = dump(w.json, -1);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t total = 12 + 8 + text.size() + (bin.empty() ? 0 : 8 + bin.size());
  if (total > 0xffffffffULL) {
    return fail(ErrorCode::cannot_write, fmt::format("would have {}, a GLB holds 4 GiB", human_bytes(total)),
                path.string(), "write .gltf, or fewer or smaller levels");
  }
  Result<OutputFile> file = OutputFile::create(path);
  LODESTONE_TRY(file);
  std::string head = "glTF";
  put_u32(head, 2);
  put_u32(head, total);
  put_u32(head, text.size());
  head += "JSON";
  file->write(head);
  file->write(text);
  if (!bin.empty()) {
    std::string chunk;
    put_u32(chunk, bin.size());
    chunk.append("BIN\0", 4);
    file->write(chunk);
    file->write(bin);
  }
  w.report.total_bytes = total;
  return file->commit();
}

Result<void> write_gltf_and_bin(Writer& w, const std::filesystem::path& path, const std::string& bin) {
  std::filesystem::path bin_path = path;
  bin_path.replace_extension(".bin");
  if (!bin.empty()) w.json["buffers"][0]["uri"] = encode_uri(bin_path.filename().string());
  const std::string text = dump(w.json, 2) + "\n";
  w.report.total_bytes = text.size() + bin.size();
  const auto put = [](const std::filesystem::path& to, const std::string& bytes) -> Result<void> {
    Result<OutputFile> file = OutputFile::create(to);
    LODESTONE_TRY(file);
    file->write(bytes);
    return file->commit();
  };
  if (bin.empty()) return put(path, text);
  // Both are whole on the disk before either appears.
  if (std::filesystem::is_directory(path) || std::filesystem::is_directory(bin_path)) {
    return fail(ErrorCode::cannot_write, "a folder of this name or of its .bin is in the way", path.string());
  }
  Result<StagingFolder> staging = StagingFolder::create(path);
  LODESTONE_TRY(staging);
  if (const Result<void> ok = put(staging->path() / bin_path.filename(), bin); !ok) {
    return fail(ok.error().code, ok.error().what, bin_path.string(), ok.error().remedy);
  }
  if (const Result<void> ok = put(staging->path() / path.filename(), text); !ok) {
    return fail(ok.error().code, ok.error().what, path.string(), ok.error().remedy);
  }
  return staging->commit();
}

void report_levels(Writer& w, const std::filesystem::path& path) {
  w.report.level_bytes = w.pack->level_bytes();
  std::uint64_t coarser = 0;
  for (std::size_t level = 1; level < w.report.level_bytes.size(); ++level) coarser += w.report.level_bytes[level];
  w.report.level_bytes[0] = w.report.total_bytes - coarser;
  w.report.files.assign(w.levels.size(), path);
}

Result<WriteReport> write(const Model& original, std::span<const Level> levels, const std::filesystem::path& path,
                          const WriteOptions& options, const Task& task) {
  LODESTONE_TRY(check(original, levels, path, options.compression));
  const Document* document = original.document.get();
  Writer w{original, levels, options, document != nullptr ? &document->data() : nullptr, {}, {}, {}, {}, {}, {}};
  if (w.document != nullptr) {
    begin_from_document(w);
  } else {
    begin_fresh(w);
  }
  LODESTONE_TRY(write_original_meshes(w, task));
  LODESTONE_TRY(write_levels(w, task));
  list_draco(w.json);
  if (w.document != nullptr) list_quantization(w.json);
  const std::string bin = w.pack->finish();
  if (bin.empty()) w.json.erase("buffers");
  if (task.cancelled()) return cancelled_error("writing");
  const bool text = extension_of(path) == ".gltf";
  LODESTONE_TRY(text ? write_gltf_and_bin(w, path, bin) : write_glb(w, path, bin));
  report_levels(w, path);
  return std::move(w.report);
}

Result<WriteReport> guarded_write(const Model& original, std::span<const Level> levels,
                                  const std::filesystem::path& path, const WriteOptions& options, const Task& task) {
  try {
    return write(original, levels, path, options, task);
  } catch (const Json::exception&) {  // reading looks at what it needs only; the rest may be of any type
    return fail(ErrorCode::bad_format, "the glTF document that the model came from has members of wrong types",
                path.string(), "repair the input, or convert it to another format first");
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::out_of_memory, "needs more memory than there is", path.string(),
                "use a machine with more, or write fewer levels");
  }
}

}  // namespace

Result<WriteReport> write_gltf(const Ladder& ladder, const std::filesystem::path& path, const WriteOptions& options,
                               Task task) {
  LODESTONE_TRY(validate(ladder, task));
  return guarded_write(ladder.original, ladder.levels, path, options, task);
}

Result<WriteReport> write_gltf(const Model& model, const std::filesystem::path& path, const WriteOptions& options,
                               Task task) {
  LODESTONE_TRY(validate(model, task));
  const Level alone;
  return guarded_write(model, std::span(&alone, 1), path, options, task);
}

}  // namespace lodestone::io
