// How textures are baked: every texel looks through the target at the source.
//
// Problem: a surface made anew has neither the colours nor the relief of its source. Method: a texel stands for a point
// of the target and shows what the source has at the place that BakeSource::find() gives for it; docs/papers/baking.md.
// 1. set_frames(): the target gets the unit normals and tangents that its normal map will refer to.
// 2. Target, normal_texel(): points and frames of the target as a viewer interpolates them, and a normal
//    in such a frame.
// 3. Baker::bake(): a tile of texels. All points of its texels (`samples_per_side` squared each) are looked up in the
//    source at once; the mean colour, in linear light, and the mean normal become the texel.
// 4. bake_textures(): detail::texel_owners() tells which triangle covers each texel, or lies beside it within what a
//    bilinear filter reads; then all tiles; then detail::dilate() carries colours on around the charts, so that smaller
//    versions of the texture don't mix in the background.
// Invariants: positions, triangles and texture coordinates of the target stay. Each tile writes texels of its own and
// distances are joined in the order of tiles, so threads change no byte.
// Cost: O(texels · samples_per_side² · log source), 24 bytes a texel.
#include "lodestone/bake/bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "lodestone/bake/dilate_detail.h"
#include "lodestone/bake/texel_owners_detail.h"
#include "lodestone/base/parallel.h"
#include "lodestone/core/srgb.h"
#include "lodestone/core/tangents.h"
#include "lodestone/core/validate.h"
#include "lodestone/spatial/smooth_normals.h"

namespace lodestone::bake {

using detail::TexelOwner;
using detail::Tiles;
using spatial::SurfacePoint;

namespace {

constexpr double kBeside = 1.5;  // texels beside a chart that are looked up, not copied
constexpr std::array<std::uint8_t, 4> kFlat{128, 128, 255, 255};

// The values of the first set of a stream as floats, or null.
const std::vector<float>* floats_of(const Mesh& mesh, Semantic semantic, std::uint32_t components) {
  const AttributeStream* stream = find_stream(mesh, semantic);
  if (stream == nullptr || stream->components != components) return nullptr;
  return std::get_if<std::vector<float>>(&stream->values);
}

Result<void> check(const Mesh& target, const BakeOptions& options) {
  if (target.triangles.empty()) return fail(ErrorCode::empty, "the target has no triangle");
  if (options.texture_size < 16 || options.texture_size > 16384) {
    return fail(ErrorCode::bad_argument,
                fmt::format("a texture of {} texels; 16 to 16384 are possible", options.texture_size));
  }
  if (options.samples_per_side < 1 || options.samples_per_side > 8) {
    return fail(ErrorCode::bad_argument,
                fmt::format("{} looks along a texel; 1 to 8 are possible", options.samples_per_side));
  }
  if (floats_of(target, Semantic::uv, 2) == nullptr) {
    return fail(ErrorCode::bad_argument, "the target has no texture coordinates", {}, "make an atlas for it first");
  }
  return {};
}

// A unit vector across n.
Vec3d any_across(Vec3d n) {
  const Vec3d a{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
  return normalized(cross(a.x <= a.y && a.x <= a.z ? Vec3d{1, 0, 0} : a.y <= a.z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1}, n));
}

// Gives the mesh the normals and tangents that its normal map refers to.
void set_frames(Mesh& mesh) {
  drop_tangents(mesh);
  if (floats_of(mesh, Semantic::normal, 3) == nullptr) {
    std::erase_if(mesh.attributes,
                  [](const AttributeStream& s) { return s.semantic == Semantic::normal && s.set == 0; });
    const std::vector<Vec3d> smooth = spatial::vertex_normals(mesh);
    AttributeStream stream =
        make_stream("NORMAL", Semantic::normal, 3, ComponentType::float32, false, mesh.wedge_count());
    auto& values = std::get<std::vector<float>>(stream.values);
    for (std::uint32_t w = 0; w < mesh.wedge_count(); ++w) {
      const Vec3d& n = smooth[mesh.vertex_of(w)];
      const Vec3f unit = to_float(n == Vec3d{} ? Vec3d{0, 0, 1} : n);
      for (std::size_t k = 0; k < 3; ++k) values[3 * std::size_t{w} + k] = unit[k];
    }
    mesh.attributes.push_back(std::move(stream));
  }
  AttributeStream tangents =
      make_stream("TANGENT", Semantic::tangent, 4, ComponentType::float32, false, mesh.wedge_count());
  auto& values = std::get<std::vector<float>>(tangents.values);
  const std::vector<float>& normals = *floats_of(mesh, Semantic::normal, 3);
  for (std::size_t w = 0; w < mesh.wedge_count(); ++w) {
    const Vec3f t =
        to_float(any_across({double(normals[3 * w]), double(normals[3 * w + 1]), double(normals[3 * w + 2])}));
    for (std::size_t k = 0; k < 3; ++k) values[4 * w + k] = t[k];
    values[4 * w + 3] = 1;
  }
  mesh.attributes.push_back(std::move(tangents));
  rebuild_tangents(mesh);  // where the texture says something
}

// Normal, tangent and bitangent of a point, unit, as a viewer interpolates them.
struct Frame {
  Vec3d normal, tangent, bitangent;
};

class Target {
 public:
  explicit Target(const Mesh& mesh)
      : mesh_(mesh),
        normals_(*floats_of(mesh, Semantic::normal, 3)),
        tangents_(*floats_of(mesh, Semantic::tangent, 4)) {}

  Vec3d point(const SurfacePoint& place) const {
    const Triangle v = mesh_.vertices_of(place.triangle);
    const Vec3d a = mesh_.position(v[0]);
    return a + (mesh_.position(v[1]) - a) * place.second + (mesh_.position(v[2]) - a) * place.third;
  }
  Vec3d normal(const SurfacePoint& place) const { return normalized(mean(place, normals_, 3)); }
  Frame frame(const SurfacePoint& place) const {
    Frame frame{normal(place), normalized(mean(place, tangents_, 4)), {}};
    const double hand = double(tangents_[4 * std::size_t{mesh_.triangles[place.triangle][0]} + 3]);
    frame.bitangent = normalized(cross(frame.normal, frame.tangent) * hand);
    return frame;
  }

 private:
  Vec3d mean(const SurfacePoint& place, const std::vector<float>& values, std::size_t width) const {
    const Triangle& wedges = mesh_.triangles[place.triangle];
    const std::array<double, 3> weights = place.weights();
    Vec3d sum;
    for (std::size_t k = 0; k < 3; ++k) {
      const float* v = values.data() + width * wedges[k];
      sum += Vec3d{double(v[0]), double(v[1]), double(v[2])} * weights[k];
    }
    return sum;
  }

  const Mesh& mesh_;
  const std::vector<float>& normals_;
  const std::vector<float>& tangents_;
};

// The normal in the frame, which need not be orthogonal, as a texel.
std::array<std::uint8_t, 4> normal_texel(Vec3d normal, const Frame& frame) {
  if (!(dot(normal, frame.normal) > 0)) return kFlat;
  const Vec3d across_t = cross(frame.bitangent, frame.normal), across_b = cross(frame.normal, frame.tangent);
  const double volume = dot(frame.tangent, across_t);
  if (!(std::abs(volume) > 1e-6)) return kFlat;
  Vec3d m{dot(normal, across_t) / volume, dot(normal, across_b) / volume,
          dot(normal, cross(frame.tangent, frame.bitangent)) / volume};
  m = normalized(m);
  if (!is_finite(m) || !(m.z > 0)) return kFlat;
  std::array<std::uint8_t, 4> texel{0, 0, 0, 255};
  for (std::size_t k = 0; k < 3; ++k) texel[k] = static_cast<std::uint8_t>(std::clamp(m[k] * 127.5 + 128, 0.0, 255.0));
  return texel;
}

void put(Pixels& pixels, std::size_t texel, const std::array<std::uint8_t, 4>& rgba) {
  std::copy(rgba.begin(), rgba.end(), pixels.rgba.begin() + static_cast<std::ptrdiff_t>(4 * texel));
}

struct Distances {
  std::uint64_t samples = 0;
  double sum = 0, max = 0;

  void add(double distance) {
    ++samples;
    sum += distance;
    max = std::max(max, distance);
  }
};

// Bakes one tile after another, each by one thread.
class Baker {
 public:
  Baker(const std::vector<TexelOwner>& owners, const BakeSource& source, const BakeOptions& options, Baked& out)
      : tiles_{options.texture_size},
        owners_(owners),
        uv_(*floats_of(out.mesh, Semantic::uv, 2)),
        target_(out.mesh),
        source_(source),
        per_side_(options.samples_per_side),
        out_(out) {}

  // Looks up all texels of a tile that have an owner.
  Distances bake(std::size_t tile) const {
    std::vector<std::size_t> texels;
    std::vector<Vec3d> points, normals;
    tiles_.for_each(tile, [&](std::uint32_t x, std::uint32_t y) {
      const std::size_t i = std::size_t{y} * tiles_.size + x;
      if (owners_[i].triangle == kNone) return;
      texels.push_back(i);
      for (std::uint32_t v = 0; v < per_side_; ++v) {
        for (std::uint32_t u = 0; u < per_side_; ++u) {
          const SurfacePoint place = place_at(i, (u + 0.5) / per_side_, (v + 0.5) / per_side_);
          points.push_back(target_.point(place));
          normals.push_back(target_.normal(place));
        }
      }
    });
    std::vector<SurfacePoint> places(points.size());
    source_.find(points, normals, places);
    Distances distances;
    const std::size_t samples = std::size_t{per_side_} * per_side_;
    for (std::size_t n = 0; n < texels.size(); ++n) {
      const auto found = std::span(places).subspan(n * samples, samples);
      write(texels[n], found);
      if (owners_[texels[n]].distance_sq > 0) continue;
      for (std::size_t k = 0; k < samples; ++k)
        distances.add(length(source_.point(found[k]) - points[n * samples + k]));
    }
    return distances;
  }

 private:
  // At a part of a texel's width and height.
  SurfacePoint place_at(std::size_t texel, double x, double y) const {
    const std::size_t column = texel % tiles_.size, row = texel / tiles_.size;
    return detail::place_in_texture(out_.mesh, uv_, tiles_.size, owners_[texel].triangle,
                                    {static_cast<double>(column) + x, static_cast<double>(row) + y});
  }

  void write(std::size_t texel, std::span<const SurfacePoint> found) const {
    if (!out_.base_color.rgba.empty()) {
      Vec3d light;
      for (const SurfacePoint& place : found) light += source_.color(place);
      light = light / static_cast<double>(found.size());
      put(out_.base_color, texel, {byte_of_light(light.x), byte_of_light(light.y), byte_of_light(light.z), 255});
    }
    if (out_.normal_map.rgba.empty()) return;
    const Frame frame = target_.frame(place_at(texel, 0.5, 0.5));
    Vec3d normal;
    for (const SurfacePoint& place : found) {
      const Vec3d theirs = source_.normal(place);
      if (dot(theirs, frame.normal) > 0) normal += theirs;
    }
    put(out_.normal_map, texel, normal_texel(normal, frame));
  }

  Tiles tiles_;
  const std::vector<TexelOwner>& owners_;
  const std::vector<float>& uv_;
  Target target_;
  const BakeSource& source_;
  std::uint32_t per_side_;
  Baked& out_;
};

Pixels blank(std::uint32_t size) {
  Pixels pixels{size, size, {}};
  pixels.rgba.assign(std::size_t{size} * size * 4, 0);
  return pixels;
}

}  // namespace

Result<Baked> bake_textures(const Mesh& target, const BakeSource& source, const BakeOptions& options, Task task) {
  LODESTONE_TRY(check(target, options));
  LODESTONE_TRY(validate(target, task));
  const std::uint32_t size = options.texture_size;
  Baked out;
  out.mesh = target;
  set_frames(out.mesh);
  if (options.base_color && source.has_color()) out.base_color = blank(size);
  if (options.normal_map) out.normal_map = blank(size);
  const std::vector<TexelOwner> owners =
      detail::texel_owners(out.mesh, *floats_of(out.mesh, Semantic::uv, 2), size, kBeside, task);
  if (task.cancelled()) return cancelled_error("baking");

  const Tiles tiles{size};
  const Baker baker(owners, source, options, out);
  std::vector<Distances> distances(tiles.count());
  parallel_for(tiles.count(), 1, task, [&](std::size_t tile, std::size_t, std::size_t) {
    distances[tile] = baker.bake(tile);
    task.advance(1 / static_cast<double>(tiles.count()));
  });
  if (task.cancelled()) return cancelled_error("baking");
  Distances all;
  for (const Distances& d : distances) all = {all.samples + d.samples, all.sum + d.sum, std::max(all.max, d.max)};
  const double samples = static_cast<double>(options.samples_per_side) * options.samples_per_side;
  out.covered = static_cast<double>(all.samples) / samples / static_cast<double>(owners.size());
  out.mean_distance = all.samples > 0 ? all.sum / static_cast<double>(all.samples) : 0;
  out.max_distance = all.max;

  // What no triangle covers.
  std::vector<std::uint8_t> set(owners.size());
  for (std::size_t i = 0; i < owners.size(); ++i) set[i] = owners[i].triangle != kNone ? 1 : 0;
  if (!out.base_color.rgba.empty()) {
    detail::dilate(out.base_color, set, options.gutter_texels, detail::mean_of(out.base_color, set), task);
  }
  if (!out.normal_map.rgba.empty()) detail::dilate(out.normal_map, set, options.gutter_texels, kFlat, task);
  if (task.cancelled()) return cancelled_error("baking");
  return out;
}

}  // namespace lodestone::bake
