// From the attribute streams of a model's meshes to what each corner of the flattened scene carries.
//
// Problem: streams belong to wedges of meshes, in the types of the file; drawing wants three normals, UVs, colours and
// numbers for each triangle of one surface in world space, packed.
// 1. DrawnTriangles: the instance, mesh, group and wedges that a triangle of the surface comes from;
//    for_each_triangle().
// 2. gather_normals(): smooth normals that keep creases (spatial::CreaseNormals), then the streams' where there are
//    any, by the transposed inverse of the instance's transform.
// 3. gather_appearances(): the material of each triangle.
// 4. gather_uvs(): only where something drawn has a texture; after the material's texture transform, origin at the top.
// 5. gather_colors(): vertex colours, 16 bits a channel; white where there are none.
// 6. values_of_meshes(), gather_values(): a number a corner for heat maps: values that were given, or a named attribute
//    (the length, where that has several components).
// 7. gather_corners(): all of them.
// Invariants: the model stays as it is; an array is empty where nothing drawn has what it holds. Each triangle is
// written by one thread: the same bytes for any thread count. Cost: O(triangles + wedges) for each of the arrays.
#include "lodestone/render/corner_streams_detail.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestone/base/parallel.h"
#include "lodestone/render/packed_normal_detail.h"
#include "lodestone/spatial/smooth_normals.h"

namespace lodestone::render::detail {

namespace {

constexpr std::size_t kChunk = 16384;
constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

double number_at(const AttributeStream& stream, std::size_t index) {
  if (const auto* floats = std::get_if<std::vector<float>>(&stream.values)) return double((*floats)[index]);
  if (const auto* doubles = std::get_if<std::vector<double>>(&stream.values)) return (*doubles)[index];
  return static_cast<double>(std::get<std::vector<std::uint32_t>>(stream.values)[index]);
}

const AttributeStream* usable(const Mesh& mesh, Semantic semantic, std::uint32_t set, std::uint32_t components) {
  const AttributeStream* stream = find_stream(mesh, semantic, set);
  return stream != nullptr && stream->components >= components && is_blendable(*stream) ? stream : nullptr;
}

// Which triangle of the model a triangle of the surface is.
struct DrawnTriangle {
  std::uint32_t instance, mesh, group;
  Triangle wedges;  // in the order of the surface's corners
};

class DrawnTriangles {
 public:
  DrawnTriangles(const Model& model, const SceneData& data) : model_(model), data_(data) {
    for (const Instance& instance : model.instances) mirrored_.push_back(instance.transform.determinant3() < 0);
  }
  DrawnTriangle of(std::size_t triangle) const {
    const std::uint32_t drawn = data_.surface.drawn[triangle];
    const auto& first = data_.first_drawn;
    const auto i = static_cast<std::uint32_t>(std::upper_bound(first.begin(), first.end(), drawn) - first.begin() - 1);
    const std::uint32_t m = model_.instances[i].mesh;
    const Mesh& mesh = model_.meshes[m];
    const std::uint32_t t = drawn - first[i];
    DrawnTriangle spot{i, m, mesh.group_of(t), mesh.triangles[t]};
    if (mirrored_[i] != 0) std::swap(spot.wedges[1], spot.wedges[2]);
    return spot;
  }

 private:
  const Model& model_;
  const SceneData& data_;
  std::vector<std::uint8_t> mirrored_;
};

// Calls body(triangle, spot) for every triangle of the surface.
template <class Body>
void for_each_triangle(const DrawnTriangles& spots, std::size_t count, const Task& task, Body&& body) {
  parallel_for(count, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) body(t, spots.of(t));
  });
}

// One pointer a mesh; null where the mesh has no usable stream.
using StreamOfMesh = std::vector<const AttributeStream*>;

template <class Find>
StreamOfMesh streams_of(const Model& model, Find&& find) {
  const std::vector<std::uint32_t> counts = instance_counts(model);
  StreamOfMesh streams;
  for (std::size_t m = 0; m < model.meshes.size(); ++m) streams.push_back(counts[m] > 0 ? find(m) : nullptr);
  return streams;
}

bool any(const StreamOfMesh& streams) {
  return std::any_of(streams.begin(), streams.end(), [](const AttributeStream* s) { return s != nullptr; });
}

void gather_normals(const Model& model, const DrawnTriangles& spots, SceneData& data, const Task& task) {
  const spatial::CreaseNormals made(data.surface, task);
  data.normals.resize(data.surface.triangles.size());
  parallel_for(data.normals.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) {
      for (std::size_t k = 0; k < 3; ++k) data.normals[t][k] = pack_normal(made.at(t, k));
    }
  });
  const StreamOfMesh streams =
      streams_of(model, [&](std::size_t m) { return usable(model.meshes[m], Semantic::normal, 0, 3); });
  if (!any(streams)) return;
  std::vector<Mat4d> inverse;
  std::vector<std::uint8_t> flat;  // squeezed to a plane or less: normals can't follow
  for (const Instance& instance : model.instances) {
    const double determinant = instance.transform.determinant3();
    inverse.push_back(instance.transform.inverse3());
    flat.push_back(!(determinant < 0 || determinant > 0));
  }
  for_each_triangle(spots, data.normals.size(), task, [&](std::size_t t, const DrawnTriangle& spot) {
    const AttributeStream* stream = streams[spot.mesh];
    if (stream == nullptr || !stream->in_group(spot.group) || flat[spot.instance] != 0) return;
    const auto& m = inverse[spot.instance].m;  // normals go by the transposed inverse
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = std::size_t{spot.wedges[k]} * stream->components;
      const Vec3d n{number_at(*stream, at), number_at(*stream, at + 1), number_at(*stream, at + 2)};
      const Vec3d world = normalized(
          Vec3d{dot(Vec3d{m[0], m[1], m[2]}, n), dot(Vec3d{m[4], m[5], m[6]}, n), dot(Vec3d{m[8], m[9], m[10]}, n)});
      if (is_finite(world) && world != Vec3d{}) data.normals[t][k] = pack_normal(world);
    }
  });
}

void gather_appearances(const Model& model, const DrawnTriangles& spots, SceneData& data, const Task& task) {
  if (model.materials.empty()) return;
  data.appearance.resize(data.surface.triangles.size());
  const auto plain = static_cast<std::uint32_t>(data.appearances.size() - 1);
  for_each_triangle(spots, data.appearance.size(), task, [&](std::size_t t, const DrawnTriangle& spot) {
    const Mesh& mesh = model.meshes[spot.mesh];
    const std::uint32_t m = spot.group < mesh.groups.size() ? mesh.groups[spot.group].material : kNone;
    data.appearance[t] = m < plain ? m : plain;
  });
}

// Non-zero for each appearance that something drawn has.
std::vector<std::uint8_t> appearances_in_use(const SceneData& data) {
  std::vector<std::uint8_t> used(data.appearances.size(), 0);
  for (const std::uint32_t appearance : data.appearance) used[appearance] = 1;
  return used;
}

void gather_uvs(const Model& model, const DrawnTriangles& spots, SceneData& data, const Task& task) {
  const std::vector<std::uint8_t> used = appearances_in_use(data);
  bool textured = false;
  for (std::size_t m = 0; m < model.materials.size(); ++m) {
    const Appearance& appearance = data.appearances[m];
    if (used.size() <= m || used[m] == 0) continue;
    textured = textured || appearance.texture != nullptr || appearance.missing;
    if (appearance.missing) {
      data.notes.push_back(
          fmt::format("the texture of material {} is missing: drawn as a checker",
                      model.materials[m].name.empty() ? fmt::format("{}", m) : "'" + model.materials[m].name + "'"));
    }
  }
  if (!textured) return;
  data.uvs.resize(data.surface.triangles.size());
  std::vector<StreamOfMesh> sets(data.appearances.size());
  for (std::size_t m = 0; m < model.materials.size(); ++m) {
    sets[m] = streams_of(model, [&](std::size_t mesh) {
      return usable(model.meshes[mesh], Semantic::uv, model.materials[m].base_color_coordinates.set, 2);
    });
  }
  for_each_triangle(spots, data.uvs.size(), task, [&](std::size_t t, const DrawnTriangle& spot) {
    const std::uint32_t appearance = data.appearance[t];
    if (appearance >= model.materials.size()) return;
    const AttributeStream* stream = sets[appearance][spot.mesh];
    if (stream == nullptr || !stream->in_group(spot.group)) return;
    const auto& map = model.materials[appearance].base_color_coordinates.map;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = std::size_t{spot.wedges[k]} * stream->components;
      const double u = number_at(*stream, at), from_file = number_at(*stream, at + 1);
      const double v = model.uv_origin_top ? from_file : 1 - from_file;
      const Vec2f uv{static_cast<float>(map[0] * u + map[1] * v + map[2]),
                     static_cast<float>(map[3] * u + map[4] * v + map[5])};
      if (std::isfinite(uv.x) && std::isfinite(uv.y)) data.uvs[t][k] = uv;
    }
  });
}

void gather_colors(const Model& model, const DrawnTriangles& spots, SceneData& data, const Task& task) {
  const StreamOfMesh streams =
      streams_of(model, [&](std::size_t m) { return usable(model.meshes[m], Semantic::color, 0, 3); });
  if (!any(streams)) return;
  constexpr PackedColor kWhite{65535, 65535, 65535, 65535};
  data.colors.assign(data.surface.triangles.size(), {kWhite, kWhite, kWhite});
  for_each_triangle(spots, data.colors.size(), task, [&](std::size_t t, const DrawnTriangle& spot) {
    const AttributeStream* stream = streams[spot.mesh];
    if (stream == nullptr || !stream->in_group(spot.group)) return;
    const double scale = 65535 / (stream->normalized ? 1 : largest_of(stream->type));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = std::size_t{spot.wedges[k]} * stream->components;
      for (std::size_t c = 0; c < std::min(4U, stream->components); ++c) {
        const double x = number_at(*stream, at + c) * scale + 0.5;
        data.colors[t][k][c] = static_cast<std::uint16_t>(x > 0 ? std::min(x, 65535.0) : 0.0);
      }
    }
  });
}

// The heat value of each wedge of a mesh; empty = none.
std::vector<float> values_of_stream(const Mesh& mesh, const std::string& name) {
  for (const AttributeStream& stream : mesh.attributes) {
    if (stream.name != name || stream.components == 0) continue;
    std::vector<float> values(mesh.wedge_count());
    for (std::size_t w = 0; w < values.size(); ++w) {
      const std::size_t at = w * stream.components;
      double sum = 0;
      for (std::size_t c = 0; c < stream.components; ++c) sum += number_at(stream, at + c) * number_at(stream, at + c);
      values[w] = static_cast<float>(stream.components == 1 ? number_at(stream, at) : std::sqrt(sum));
    }
    return values;
  }
  return {};
}

Result<std::vector<std::vector<float>>> values_of_meshes(const Model& model, const SceneOptions& options) {
  std::vector<std::vector<float>> values = options.values;
  if (!values.empty() && values.size() != model.meshes.size()) {
    return fail(ErrorCode::bad_argument,
                fmt::format("there are values for {} meshes, the model has {}", values.size(), model.meshes.size()));
  }
  if (values.empty() && !options.attribute.empty()) {
    for (const Mesh& mesh : model.meshes) values.push_back(values_of_stream(mesh, options.attribute));
    if (std::all_of(values.begin(), values.end(), [](const auto& list) { return list.empty(); })) {
      std::vector<std::string> names;
      for (const Mesh& mesh : model.meshes) {
        for (const AttributeStream& stream : mesh.attributes) {
          if (std::find(names.begin(), names.end(), stream.name) == names.end()) names.push_back(stream.name);
        }
      }
      return fail(ErrorCode::bad_argument, fmt::format("the model has no attribute '{}'", options.attribute), {},
                  names.empty() ? "it has no attributes at all" : fmt::format("it has: {}", fmt::join(names, ", ")));
    }
  }
  for (std::size_t m = 0; m < values.size(); ++m) {
    const Mesh& mesh = model.meshes[m];
    if (values[m].empty() || values[m].size() == mesh.wedge_count()) continue;
    if (values[m].size() != mesh.vertex_count()) {
      return fail(ErrorCode::bad_argument, fmt::format("mesh {} has {} values, but {} wedges and {} vertices", m,
                                                       values[m].size(), mesh.wedge_count(), mesh.vertex_count()));
    }
    std::vector<float> of_wedges(mesh.wedge_count());
    for (std::uint32_t w = 0; w < of_wedges.size(); ++w) of_wedges[w] = values[m][mesh.vertex_of(w)];
    values[m] = std::move(of_wedges);
  }
  return values;
}

Result<void> gather_values(const Model& model, const DrawnTriangles& spots, const SceneOptions& options,
                           SceneData& data, const Task& task) {
  const Result<std::vector<std::vector<float>>> values = values_of_meshes(model, options);
  LODESTONE_TRY(values);
  if (values->empty()) return {};
  data.values.assign(data.surface.triangles.size(), {kNoValue, kNoValue, kNoValue});
  for_each_triangle(spots, data.values.size(), task, [&](std::size_t t, const DrawnTriangle& spot) {
    const std::vector<float>& list = (*values)[spot.mesh];
    if (list.empty()) return;
    for (std::size_t k = 0; k < 3; ++k) data.values[t][k] = list[spot.wedges[k]];
  });
  bool first = true;
  for (const Corners<float>& corners : data.values) {
    for (const float value : corners) {
      if (!std::isfinite(value)) continue;
      data.least_value = first ? value : std::min(data.least_value, value);
      data.largest_value = first ? value : std::max(data.largest_value, value);
      first = false;
    }
  }
  return {};
}

}  // namespace

Result<void> gather_corners(const Model& model, const SceneOptions& options, SceneData& data, const Task& task) {
  const DrawnTriangles spots(model, data);
  gather_normals(model, spots, data, task);
  gather_appearances(model, spots, data, task);
  gather_uvs(model, spots, data, task);
  gather_colors(model, spots, data, task);
  return gather_values(model, spots, options, data, task);
}

}  // namespace lodestone::render::detail
