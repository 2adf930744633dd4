// What a model's surface shows at a point, as a viewer would draw it: normals, texture coordinates and colours.
//
// 1. The constructor notes which streams each mesh has (usable()), and how each instance's transform turns normals.
//    note_sets() lists the UV sets that anything drawn has.
// 2. drawn_triangle() finds the instance, mesh, group and wedges of a triangle of the flattened surface.
// 3. The reading functions interpolate within it (interpolated()): stream_normal(), and normal(), which falls back on
//    the face's; uv(), with the origin at the image's top; color(); and light(), which is base colour times texture
//    times vertex colour, linear.
// 4. uv_diagonal() measures the box of a UV set.
//
// A value is nothing where the primitive does not have the stream, or a corner's number is not finite. Nothing is
// changed after construction, so any number of threads may read. O(log instances) a point.
#include "lodestone/spatial/drawn_attributes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lodestone/core/texture.h"
#include "lodestone/math/triangle.h"

namespace lodestone::spatial {

namespace {

// More sets than any model has; a file that claims more is not worth the time.
constexpr std::uint32_t kMostSets = 16;

double value_at(const AttributeStream& stream, std::size_t index) {
  if (const auto* floats = std::get_if<std::vector<float>>(&stream.values)) return double((*floats)[index]);
  if (const auto* doubles = std::get_if<std::vector<double>>(&stream.values)) return (*doubles)[index];
  return 0;
}

// The first N components, interpolated; nothing where the stream or a finite number is missing.
template <std::size_t N>
std::optional<std::array<double, N>> interpolated(const AttributeStream* stream, std::uint32_t group,
                                                  const Triangle& wedges, const SurfacePoint& place) {
  if (stream == nullptr || !stream->in_group(group)) return std::nullopt;
  const std::array<double, 3> weights = place.weights();
  std::array<double, N> out{};
  for (std::size_t corner = 0; corner < 3; ++corner) {
    for (std::size_t k = 0; k < N; ++k) {
      out[k] += weights[corner] * value_at(*stream, std::size_t{wedges[corner]} * stream->components + k);
    }
  }
  for (const double x : out) {
    if (!std::isfinite(x)) return std::nullopt;
  }
  return out;
}

// The stream, if it can be blended and has at least `components`.
const AttributeStream* usable(const Mesh& mesh, Semantic semantic, std::uint32_t set, std::uint32_t components) {
  const AttributeStream* stream = find_stream(mesh, semantic, set);
  return stream != nullptr && stream->components >= components && is_blendable(*stream) ? stream : nullptr;
}

bool is_plain(const Material& material) {
  const auto& c = material.base_color;
  return material.base_color_texture == nullptr && c[0] == 1 && c[1] == 1 && c[2] == 1;
}

}  // namespace

DrawnAttributes::DrawnAttributes(const Model& model, const spatial::Surface& surface)
    : model_(model), surface_(surface), first_{0}, streams_(model.meshes.size()) {
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    const Mesh& mesh = model.meshes[m];
    Streams& streams = streams_[m];
    streams.normal = usable(mesh, Semantic::normal, 0, 3);
    streams.color = usable(mesh, Semantic::color, 0, 3);
    for (std::uint32_t set = 0; set < kMostSets; ++set) {
      streams.uv.push_back(usable(mesh, Semantic::uv, set, 2));
    }
  }
  for (const Instance& instance : model.instances) {
    first_.push_back(first_.back() + static_cast<std::uint32_t>(model.meshes[instance.mesh].triangles.size()));
    const double determinant = instance.transform.determinant3();
    to_local_.push_back(instance.transform.inverse3());
    mirrored_.push_back(determinant < 0);
    flat_.push_back(!(determinant < 0 || determinant > 0));
  }
  note_sets();
}

void DrawnAttributes::note_sets() {
  std::array<bool, kMostSets> there{};
  for (const Instance& instance : model_.instances) {
    const Mesh& mesh = model_.meshes[instance.mesh];
    const Streams& streams = streams_[instance.mesh];
    has_normals_ = has_normals_ || streams.normal != nullptr;
    has_color_ = has_color_ || streams.color != nullptr;
    for (std::size_t set = 0; set < kMostSets; ++set) there[set] = there[set] || streams.uv[set] != nullptr;
    for (const FaceGroup& group : mesh.groups) {
      has_appearance_ =
          has_appearance_ || (group.material < model_.materials.size() && !is_plain(model_.materials[group.material]));
    }
  }
  has_appearance_ = has_appearance_ || has_color_;
  for (std::uint32_t set = 0; set < kMostSets; ++set) {
    if (there[set]) uv_sets_.push_back(set);
  }
}

DrawnAttributes::DrawnTriangle DrawnAttributes::drawn_triangle(std::uint32_t triangle) const {
  const std::uint32_t drawn = surface_.drawn[triangle];
  const auto instance =
      static_cast<std::uint32_t>(std::upper_bound(first_.begin(), first_.end(), drawn) - first_.begin() - 1);
  const std::uint32_t m = model_.instances[instance].mesh;
  const Mesh& mesh = model_.meshes[m];
  const std::uint32_t t = drawn - first_[instance];
  DrawnTriangle spot{&mesh, &streams_[m], instance, mesh.group_of(t), mesh.triangles[t]};
  if (mirrored_[instance] != 0) std::swap(spot.wedges[1], spot.wedges[2]);
  return spot;
}

std::optional<Vec3d> DrawnAttributes::stream_normal(const SurfacePoint& place) const {
  const DrawnTriangle at = drawn_triangle(place.triangle);
  if (flat_[at.instance] != 0) return std::nullopt;
  const auto n = interpolated<3>(at.streams->normal, at.group, at.wedges, place);
  if (!n) return std::nullopt;
  const std::array<double, 16>& m = to_local_[at.instance].m;  // normals go by the transposed inverse
  const Vec3d local{(*n)[0], (*n)[1], (*n)[2]};
  const Vec3d world = normalized(Vec3d{dot(Vec3d{m[0], m[1], m[2]}, local), dot(Vec3d{m[4], m[5], m[6]}, local),
                                       dot(Vec3d{m[8], m[9], m[10]}, local)});
  if (world == Vec3d{} || !is_finite(world)) return std::nullopt;
  return world;
}

std::optional<Vec3d> DrawnAttributes::normal(const SurfacePoint& place) const {
  if (const std::optional<Vec3d> own = stream_normal(place)) return own;
  const auto [a, b, c] = surface_.corners(place.triangle);
  const Vec3d face = normalized(scaled_normal(a, b, c));
  if (face == Vec3d{}) return std::nullopt;
  return face;
}

std::optional<Vec2d> DrawnAttributes::uv_at(const DrawnTriangle& at, const SurfacePoint& place,
                                            std::uint32_t set) const {
  if (set >= kMostSets) return std::nullopt;
  const auto uv = interpolated<2>(at.streams->uv[set], at.group, at.wedges, place);
  if (!uv) return std::nullopt;
  return Vec2d{(*uv)[0], model_.uv_origin_top ? (*uv)[1] : 1 - (*uv)[1]};
}

std::optional<Vec2d> DrawnAttributes::uv(const SurfacePoint& place, std::uint32_t set) const {
  return uv_at(drawn_triangle(place.triangle), place, set);
}

std::optional<Vec3d> DrawnAttributes::color_at(const DrawnTriangle& at, const SurfacePoint& place) const {
  const auto rgb = interpolated<3>(at.streams->color, at.group, at.wedges, place);
  if (!rgb) return std::nullopt;
  const double white = at.streams->color->normalized ? 1 : largest_of(at.streams->color->type);
  Vec3d out;
  for (std::size_t k = 0; k < 3; ++k) out[k] = std::clamp((*rgb)[k] / white, 0.0, 1.0);
  return out;
}

std::optional<Vec3d> DrawnAttributes::color(const SurfacePoint& place) const {
  return color_at(drawn_triangle(place.triangle), place);
}

Vec3d DrawnAttributes::light(const SurfacePoint& place) const {
  const DrawnTriangle at = drawn_triangle(place.triangle);
  Vec3d light = color_at(at, place).value_or(Vec3d{1, 1, 1});
  const std::uint32_t m = at.group < at.mesh->groups.size() ? at.mesh->groups[at.group].material : kNone;
  if (m < model_.materials.size()) {
    const Material& material = model_.materials[m];
    for (std::size_t k = 0; k < 3; ++k) light[k] *= double(material.base_color[k]);
    if (material.base_color_pixels != nullptr) {
      if (const auto uv = uv_at(at, place, material.base_color_coordinates.set)) {
        const Vec3d texel = texture_light(*material.base_color_pixels, mapped(*uv, material.base_color_coordinates));
        for (std::size_t k = 0; k < 3; ++k) light[k] *= texel[k];
      }
    }
  }
  return light;
}

double DrawnAttributes::uv_diagonal(std::uint32_t set) const {
  double low_u = 0, high_u = 0, low_v = 0, high_v = 0;
  bool any = false;
  for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) {
    for (const SurfacePoint& corner : {SurfacePoint{t, 0, 0}, SurfacePoint{t, 1, 0}, SurfacePoint{t, 0, 1}}) {
      const std::optional<Vec2d> at = uv(corner, set);
      if (!at) continue;
      low_u = any ? std::min(low_u, at->x) : at->x;
      high_u = any ? std::max(high_u, at->x) : at->x;
      low_v = any ? std::min(low_v, at->y) : at->y;
      high_v = any ? std::max(high_v, at->y) : at->y;
      any = true;
    }
  }
  return std::sqrt((high_u - low_u) * (high_u - low_u) + (high_v - low_v) * (high_v - low_v));
}

}  // namespace lodestone::spatial
