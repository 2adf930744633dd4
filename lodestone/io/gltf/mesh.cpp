// A glTF mesh as a Mesh: its triangle primitives are the face groups, in order; its attributes the streams.
#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "lodestone/base/parallel.h"
#include "lodestone/io/gltf/gltf_detail.h"
#include "lodestone/io/gltf/primitive_detail.h"

namespace lodestone::io {

namespace {

constexpr std::size_t kChunk = std::size_t{1} << 16;

// "TEXCOORD_12" with prefix "TEXCOORD_": 12.
std::optional<std::uint32_t> set_of(std::string_view name, std::string_view prefix) {
  if (!name.starts_with(prefix) || name.size() == prefix.size() || name.size() > prefix.size() + 4) return std::nullopt;
  std::uint32_t set = 0;
  for (const char c : name.substr(prefix.size())) {
    if (c < '0' || c > '9') return std::nullopt;
    set = set * 10 + static_cast<std::uint32_t>(c - '0');
  }
  return set;
}

// Where a stream's values come from: attribute `name` of the primitives, or of their morph target `target`.
struct StreamSource {
  std::string name;
  bool morph = false;
  std::uint32_t target = 0;
  std::vector<const Accessor*> of_group;  // null where the primitive lacks it
};

void add_source(std::vector<StreamSource>& sources, const std::string& name, bool morph, std::size_t target,
                std::size_t group, std::size_t groups, const Accessor& accessor) {
  auto found = std::find_if(sources.begin(), sources.end(), [&](const StreamSource& s) {
    return s.morph == morph && s.target == target && s.name == name;
  });
  if (found == sources.end()) {
    sources.push_back({name, morph, static_cast<std::uint32_t>(target), std::vector<const Accessor*>(groups, nullptr)});
    found = std::prev(sources.end());
  }
  found->of_group[group] = &accessor;
}

std::vector<StreamSource> find_sources(const std::vector<PrimitiveSource>& primitives) {
  std::vector<StreamSource> sources;
  for (std::size_t g = 0; g < primitives.size(); ++g) {
    for (const auto& [name, accessor] : primitives[g].attributes) {
      add_source(sources, name, false, 0, g, primitives.size(), accessor);
    }
    for (std::size_t t = 0; t < primitives[g].targets.size(); ++t) {
      for (const auto& [name, accessor] : primitives[g].targets[t]) {
        add_source(sources, name, true, t, g, primitives.size(), accessor);
      }
    }
  }
  return sources;
}

std::size_t components_of(const StreamSource& source) {
  std::size_t components = 0;
  for (const Accessor* a : source.of_group) {
    if (a != nullptr) components = std::max(components, a->components);
  }
  return components;
}

// The stream's type is the primitives' common one; where they differ, values are floats (writing back asks each
// primitive).
AttributeStream empty_stream(const StreamSource& source, std::size_t wedges) {
  const AttributeKind kind = attribute_kind(source.name, source.morph);
  const Accessor* first = nullptr;
  const std::size_t components = components_of(source);
  bool mixed = false, all = true;
  for (const Accessor* a : source.of_group) {
    all = all && a != nullptr;
    if (a == nullptr) continue;
    if (first == nullptr) first = a;
    mixed = mixed || a->type != first->type || a->normalized != first->normalized;
  }
  ComponentType type = mixed ? ComponentType::float32 : first->type;
  Semantic semantic = kind.semantic;
  const bool integer = type != ComponentType::float32 && !first->normalized;
  if (semantic == Semantic::generic && integer && !mixed) semantic = Semantic::categorical;
  if (semantic == Semantic::joints && type == ComponentType::float32) type = ComponentType::uint16;
  AttributeStream stream = make_stream(source.name, semantic, static_cast<std::uint32_t>(components), type,
                                       !mixed && first->normalized, wedges);
  stream.set = kind.set;
  stream.target = source.target;
  if (!all) {
    for (const Accessor* a : source.of_group) stream.present.push_back(a != nullptr);
  }
  return stream;
}

void fill_stream(const StreamSource& source, const std::vector<PrimitiveSource>& primitives, AttributeStream& stream,
                 const Task& task) {
  std::size_t wedge = 0;
  const float missing = stream.semantic == Semantic::color ? 1.0f : 0.0f;  // opaque where there is no alpha
  for (std::size_t g = 0; g < primitives.size(); ++g) {
    const std::size_t count = primitives[g].vertex_count, at = wedge * stream.components;
    wedge += count;
    if (source.of_group[g] == nullptr || count == 0) continue;
    const Accessor& accessor = *source.of_group[g];
    if (auto* floats = std::get_if<std::vector<float>>(&stream.values); floats != nullptr) {
      gather(accessor, primitives[g].vertices, count, floats->data() + at, stream.components, missing, task);
    } else if (auto* bits = std::get_if<std::vector<std::uint32_t>>(&stream.values); bits != nullptr) {
      gather_bits(accessor, primitives[g].vertices, count, bits->data() + at, stream.components, task);
    }
  }
}

Result<void> check_finite(const Mesh& mesh, std::size_t first, const PrimitiveSource& source, const Task& task) {
  const std::size_t bad = parallel_reduce(
      source.vertex_count, kChunk, task, source.vertex_count,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          if (!is_finite(mesh.positions[first + i])) return i;
        }
        return source.vertex_count;
      },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
  if (bad == source.vertex_count) return {};
  const Vec3f p = mesh.positions[first + bad];
  return fail(ErrorCode::bad_format,
              fmt::format("position {} is ({}, {}, {}), not finite",
                          source.vertices.empty() ? bad : source.vertices[bad], p.x, p.y, p.z),
              source.positions.where, "export the model again");
}

void append_triangles(Mesh& mesh, PrimitiveSource& source, std::size_t group, std::size_t first_wedge) {
  if (mesh.triangles.empty() && first_wedge == 0 && group == 0) {
    mesh.triangles = std::move(source.triangles);
    return;
  }
  const auto base = static_cast<std::uint32_t>(first_wedge);
  if (group > 0) mesh.face_group.resize(mesh.triangles.size(), 0);  // group 0's, which needed none alone
  for (const Triangle& t : source.triangles) mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  if (group > 0) mesh.face_group.resize(mesh.triangles.size(), static_cast<std::uint32_t>(group));
}

Result<std::vector<PrimitiveSource>> read_primitives(const Document::Data& data, std::size_t index, const Json& json,
                                                     Budget& budget, DracoCache& cache, Model& model,
                                                     const Task& task) {
  std::vector<PrimitiveSource> primitives;
  const Json& list = array_member(json, "primitives");
  for (std::size_t p = 0; p < list.size(); ++p) {
    if (task.cancelled()) return cancelled_error("reading");
    if (!is_triangle_primitive(list[p])) continue;
    const std::string where = fmt::format("{}: mesh {} primitive {}", data.name, index, p);
    Result<PrimitiveSource> source = read_primitive(data, list[p], where, budget, cache, model.warnings);
    LODESTONE_TRY(source);
    primitives.push_back(std::move(*source));
  }
  return primitives;
}

}  // namespace

AttributeKind attribute_kind(std::string_view name, bool morph) {
  if (morph) {
    if (name == "POSITION") return {Semantic::morph_position, 0};
    if (name == "NORMAL") return {Semantic::morph_normal, 0};
    if (name == "TANGENT") return {Semantic::morph_tangent, 0};
    for (const std::string_view prefix : {"TEXCOORD_", "COLOR_"}) {
      if (const auto set = set_of(name, prefix)) return {Semantic::morph_other, *set};
    }
    return {Semantic::morph_other, 0};
  }
  if (name == "NORMAL") return {Semantic::normal, 0};
  if (name == "TANGENT") return {Semantic::tangent, 0};
  constexpr std::pair<std::string_view, Semantic> numbered[] = {{"TEXCOORD_", Semantic::uv},
                                                                {"COLOR_", Semantic::color},
                                                                {"JOINTS_", Semantic::joints},
                                                                {"WEIGHTS_", Semantic::weights},
                                                                {"_FEATURE_ID_", Semantic::categorical}};
  for (const auto& [prefix, semantic] : numbered) {
    if (const auto set = set_of(name, prefix)) return {semantic, *set};
  }
  if (name == "_BATCHID") return {Semantic::categorical, 0};
  return {Semantic::generic, 0};
}

Result<Mesh> read_mesh(const Document::Data& data, std::size_t index, Budget& budget, DracoCache& cache, Model& model,
                       const Task& task) {
  const Json& json = array_member(data.json, "meshes")[index];
  Result<std::vector<PrimitiveSource>> primitives = read_primitives(data, index, json, budget, cache, model, task);
  LODESTONE_TRY(primitives);

  Mesh mesh;
  mesh.name = string_member(json, "name");
  std::size_t wedges = 0, triangles = 0;
  for (const PrimitiveSource& source : *primitives) {
    wedges += source.vertex_count;
    triangles += source.triangles.size();
    model.file_vertices += source.positions.count;
  }
  model.file_triangles += triangles;
  const std::vector<StreamSource> sources = find_sources(*primitives);
  std::uint64_t wedge_bytes = sizeof(Vec3f);
  for (const StreamSource& source : sources) wedge_bytes += 4 * components_of(source);
  if (wedges >= kNone || !budget.take(wedges * wedge_bytes)) {
    return unfolds_too_far(data, "the primitives", place(data, "mesh", index));
  }
  mesh.positions.resize(wedges);
  if (primitives->size() > 1) mesh.triangles.reserve(triangles);
  std::size_t first = 0;
  for (std::size_t g = 0; g < primitives->size(); ++g) {
    PrimitiveSource& source = (*primitives)[g];
    if (source.vertex_count > 0) {
      gather(source.positions, source.vertices, source.vertex_count, &mesh.positions[first].x, 3, 0.0f, task);
      if (const auto good = check_finite(mesh, first, source, task); !good) return fail(good.error());
    }
    append_triangles(mesh, source, g, first);
    mesh.groups.push_back({source.material, {}});
    first += source.vertex_count;
  }
  for (const StreamSource& source : sources) {
    if (task.cancelled()) return cancelled_error("reading");
    mesh.attributes.push_back(empty_stream(source, wedges));
    fill_stream(source, *primitives, mesh.attributes.back(), task);
  }
  if (task.cancelled()) return cancelled_error("reading");
  return mesh;
}

}  // namespace lodestone::io
