#include <fmt/format.h>

#include <algorithm>

#include "lodestone/base/memory.h"
#include "lodestone/io/plain/obj_faces_detail.h"
#include "lodestone/io/read_detail.h"

namespace lodestone::io {

// From an index of the file (1 is the first, -1 the latest) to ours.
ObjFaces::Fault ObjFaces::resolve(std::int64_t index, std::uint64_t count, std::size_t known, const char* kind,
                                  std::uint32_t& into) {
  const std::int64_t at = index > 0 ? index - 1 : static_cast<std::int64_t>(count) + index;
  if (index == 0) return {fmt::format("a face names {} 0", kind), "OBJ counts from 1: check the exporter's index base"};
  if (at < 0) return {fmt::format("a face names {} {}, but only {} came before it", kind, index, count), {}};
  if (static_cast<std::uint64_t>(at) >= known) {
    names_later_ = names_later_ || !complete_;
    return {fmt::format("a face names {} {}, the file has {}", kind, index, known), "is the file damaged or cut off?"};
  }
  into = static_cast<std::uint32_t>(at);
  return {};
}

ObjFaces::Fault ObjFaces::take_corners(WordScanner& words, const ObjData& data, const ObjCounts& counts) {
  corners_.clear();
  while (!words.at_end()) {
    WordScanner start = words;
    Corner corner;
    std::int64_t index = 0;
    const auto not_a_corner = [&]() -> Fault {
      return {fmt::format("'{}' is not a corner of a face", start.word().substr(0, 40)),
              "expected v, v/vt, v//vn or v/vt/vn"};
    };
    if (!words.integer(index)) return not_a_corner();
    if (Fault fault = resolve(index, counts.positions, data.positions.size(), "vertex", corner.position);
        !fault.what.empty()) {
      return fault;
    }
    if (words.take('/')) {
      if (words.integer(index)) {
        if (Fault fault = resolve(index, counts.uvs, data.uvs.size(), "texture coordinate", corner.uv);
            !fault.what.empty()) {
          return fault;
        }
      }
      if (words.take('/') && words.integer(index)) {
        if (Fault fault = resolve(index, counts.normals, data.normals.size(), "normal", corner.normal);
            !fault.what.empty()) {
          return fault;
        }
      }
    }
    if (!words.at_word_end()) return not_a_corner();
    corners_.push_back(corner);
  }
  return {};
}

// The corners' indices as the triangles name them: vertices until a corner has a UV or a normal, wedges from then on.
void ObjFaces::name_corners(const ObjData& data) {
  if (!has_wedges_) {
    has_wedges_ = std::any_of(corners_.begin(), corners_.end(),
                              [](const Corner& c) { return c.uv != kNone || c.normal != kNone; });
    if (has_wedges_ && !triangles_.empty()) table_.start_with_vertices(data.positions.size());
  }
  named_.clear();
  for (const Corner& c : corners_)
    named_.push_back(has_wedges_ ? table_.wedge(c.position, c.uv, c.normal) : c.position);
}

void ObjFaces::add_polygon(const ObjData& data, std::uint32_t group) {
  if (corners_.size() < 3) {
    ++short_faces_;
    return;
  }
  file_triangles_ += corners_.size() - 2;
  if (group >= presence_.size()) presence_.resize(std::size_t{group} + 1);
  Presence& presence = presence_[group];
  for (const Corner& c : corners_) {
    (c.uv != kNone ? presence.with_uv : presence.without_uv) = true;
    (c.normal != kNone ? presence.with_normal : presence.without_normal) = true;
  }
  name_corners(data);
  if (corners_.size() == 3) {
    triangles_.push_back({named_[0], named_[1], named_[2]});
  } else {
    points_.clear();
    for (const Corner& c : corners_) points_.push_back(data.positions[c.position]);
    for (const CornerTriple& t : cutter_.cut(points_)) triangles_.push_back({named_[t[0]], named_[t[1]], named_[t[2]]});
  }
  if (group > 0 && face_group_.empty() && triangles_.size() > corners_.size() - 2) {
    face_group_.resize(triangles_.size() - (corners_.size() - 2), 0);  // so far all were in group 0
  }
  if (group > 0 || !face_group_.empty()) face_group_.resize(triangles_.size(), group);
}

namespace {

// Colours by wedge; vertices without one are white. `wedge_vertex` empty: wedge is vertex.
AttributeStream color_stream(const ObjData& data, const std::vector<std::uint32_t>& wedge_vertex, std::size_t wedges) {
  const bool has_alpha = std::find(data.color_parts.begin(), data.color_parts.end(), 4) != data.color_parts.end();
  const std::uint32_t components = has_alpha ? 4 : 3;
  const bool bytes = data.color_range.is_bytes();
  AttributeStream stream = make_stream("COLOR_0", Semantic::color, components,
                                       bytes ? ComponentType::uint8 : ComponentType::float32, bytes, wedges);
  auto& values = std::get<std::vector<float>>(stream.values);
  const float divisor = data.color_range.divisor();
  for (std::size_t w = 0; w < wedges; ++w) {
    const std::size_t v = wedge_vertex.empty() ? w : wedge_vertex[w];
    for (std::size_t c = 0; c < components; ++c) {
      values[components * w + c] = c < data.color_parts[v] ? data.colors[4 * v + c] / divisor : 1.0F;
    }
  }
  return stream;
}

}  // namespace

void ObjFaces::fill(Mesh& mesh, Model& model, ObjData& data) {
  model.file_triangles = file_triangles_;
  mesh.triangles = std::move(triangles_);
  mesh.face_group = std::move(face_group_);
  if (short_faces_ > 0) {
    model.warnings.push_back(
        fmt::format("{} with fewer than 3 corners skipped", counted(short_faces_, "face", "faces")));
  }
  const std::size_t wedges = has_wedges_ ? table_.wedge_vertex.size() : data.positions.size();
  const auto presence = [&](bool Presence::*with, bool Presence::*without, const char* what, AttributeStream& stream) {
    bool in_all = true;
    std::size_t mixed = 0;
    for (const Presence& p : presence_) {
      in_all = in_all && p.*with;
      mixed += p.*with && p.*without ? 1 : 0;
    }
    if (mixed > 0) {
      model.warnings.push_back(fmt::format("some corners have no {} in {} that has them: set to zero", what,
                                           counted(mixed, "group", "groups")));
    }
    if (in_all) return;
    for (const Presence& p : presence_) stream.present.push_back(p.*with ? 1 : 0);
  };
  const auto used = [&](bool Presence::*with) {
    return std::any_of(presence_.begin(), presence_.end(), [&](const Presence& p) { return p.*with; });
  };
  if (used(&Presence::with_normal)) {
    AttributeStream stream = make_stream("NORMAL", Semantic::normal, 3, ComponentType::float32, false, wedges);
    auto& values = std::get<std::vector<float>>(stream.values);
    for (std::size_t w = 0; w < wedges; ++w) {
      const std::uint32_t key = table_.key_b[w];
      const Vec3f n = key == kNone ? Vec3f{} : data.normals[key];
      values[3 * w] = n.x, values[3 * w + 1] = n.y, values[3 * w + 2] = n.z;
    }
    presence(&Presence::with_normal, &Presence::without_normal, "normal", stream);
    mesh.attributes.push_back(std::move(stream));
  }
  free_memory(data.normals);
  free_memory(table_.key_b);
  if (used(&Presence::with_uv)) {
    AttributeStream stream = make_stream("TEXCOORD_0", Semantic::uv, 2, ComponentType::float32, false, wedges);
    auto& values = std::get<std::vector<float>>(stream.values);
    for (std::size_t w = 0; w < wedges; ++w) {
      const std::uint32_t key = table_.key_a[w];
      const Vec2f uv = key == kNone ? Vec2f{} : data.uvs[key];
      values[2 * w] = uv.x, values[2 * w + 1] = uv.y;
    }
    presence(&Presence::with_uv, &Presence::without_uv, "texture coordinate", stream);
    mesh.attributes.push_back(std::move(stream));
  }
  free_memory(data.uvs);
  free_memory(table_.key_a);
  if (!data.colors.empty()) {
    mesh.attributes.push_back(color_stream(data, table_.wedge_vertex, wedges));
    free_memory(data.colors);
    free_memory(data.color_parts);
  }
  mesh.wedge_vertex = std::move(table_.wedge_vertex);
  table_ = {};
}

}  // namespace lodestone::io
