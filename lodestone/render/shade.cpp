#include "lodestone/render/shade_detail.h"

#include <algorithm>
#include <cmath>

#include "lodestone/math/triangle.h"
#include "lodestone/render/color_map.h"
#include "lodestone/render/tone_detail.h"

namespace lodestone::render::detail {

namespace {

constexpr Vec3f kClay{0.62F, 0.60F, 0.575F};         // what has no colour of its own, as light
constexpr Vec3f kBackColor{0.13F, 0.20F, 0.36F};     // faces from behind
constexpr Vec3f kNoValueColor{0.45F, 0.45F, 0.45F};  // heat without a value
constexpr Vec3f kWire{0.01F, 0.012F, 0.02F};

Vec3f times(Vec3f a, Vec3f b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

Vec3f normalized_or(Vec3f a, Vec3f other) {
  const float sq = dot(a, a);
  return sq > 1e-12F && sq < 1e12F ? a * (1 / std::sqrt(sq)) : other;
}

}  // namespace

Shader::Shader(const Raster& raster, const RenderOptions& options, const HeatRange& range)
    : raster_(raster), scene_(raster.scene()), options_(options), heat_least_(static_cast<float>(range.least)) {
  const double span = range.largest - range.least;
  heat_per_unit_ = span > 0 ? static_cast<float>(1 / span) : 0;
  const Camera& camera = raster.projection().camera();
  key_ = to_float(normalized(camera.up * 0.45 - camera.right * 0.35 - camera.forward));
  sky_ = to_float(camera.up);
  eye_ = to_float(-camera.forward);
}

Vec3f Shader::normal_at(std::uint32_t id, const Fragment& fragment, bool of_face) const {
  Vec3f normal = eye_;
  if (of_face) {
    const auto [a, b, c] = scene_.surface.corners(id);
    normal = normalized_or(to_float(normalized(scaled_normal(a, b, c))), eye_);
  } else {
    const Corners<PackedNormal>& n = scene_.normals[id];
    normal = normalized_or(fragment.mix(unpack_normal(n[0]), unpack_normal(n[1]), unpack_normal(n[2])), eye_);
  }
  return fragment.back ? -normal : normal;
}

// 1 where the light meets the surface square-on.
float Shader::brightness(Vec3f normal) const {
  const float direct = std::max(dot(normal, key_), 0.0F);
  const float sky = 0.5F + 0.5F * dot(normal, sky_);
  return 0.78F * direct + 0.16F * sky + 0.10F;
}

Vec3f Shader::vertex_color(std::uint32_t id, const Fragment& fragment) const {
  if (scene_.colors.empty()) return {1, 1, 1};
  const auto light = [](const PackedColor& c) {
    constexpr float kScale = 1.0F / 65535;
    return Vec3f{static_cast<float>(c[0]) * kScale, static_cast<float>(c[1]) * kScale,
                 static_cast<float>(c[2]) * kScale};
  };
  const Corners<PackedColor>& c = scene_.colors[id];
  return fragment.mix(light(c[0]), light(c[1]), light(c[2]));
}

Vec3f Shader::texture_color(std::uint32_t id, Vec2f at, const Fragment& fragment, const Appearance& appearance) const {
  if (scene_.uvs.empty() || (appearance.texture == nullptr && !appearance.missing)) return {1, 1, 1};
  const Corners<Vec2f>& uv = scene_.uvs[id];
  const auto uv_of = [&](const Fragment& f) {
    return Vec2f{f.mix(uv[0].x, uv[1].x, uv[2].x), f.mix(uv[0].y, uv[1].y, uv[2].y)};
  };
  const Vec2f here = uv_of(fragment);
  if (appearance.missing) {
    const auto odd = [](float x) { return static_cast<std::int32_t>(std::clamp(x, -1e5F, 1e5F) * 16 + 1.7e6F) & 1; };
    return odd(here.x) != odd(here.y) ? Vec3f{0.75F, 0.02F, 0.55F} : Vec3f{0.04F, 0.04F, 0.04F};
  }
  // Towards the triangle's inside where a pixel further would leave it.
  const auto step = [&](Vec2f to) {
    const Vec2f there = uv_of(fragment_at(raster_, id, to));
    return Vec2f{there.x - here.x, there.y - here.y};
  };
  const auto longer = [](Vec2f a, Vec2f b) { return a.x * a.x + a.y * a.y >= b.x * b.x + b.y * b.y ? a : b; };
  const Vec2f per_x = longer(step({at.x + 1, at.y}), step({at.x - 1, at.y}));
  const Vec2f per_y = longer(step({at.x, at.y + 1}), step({at.x, at.y - 1}));
  return appearance.texture->sample(here, per_x, per_y).light;
}

Vec3f Shader::base_color(std::uint32_t id, Vec2f at, const Fragment& fragment) const {
  const Appearance& appearance = scene_.appearance_of(id);
  switch (options_.shading) {
    case Shading::textured:
      return times(times(appearance.color, vertex_color(id, fragment)), texture_color(id, at, fragment, appearance));
    case Shading::vertex_color:
      return vertex_color(id, fragment);
    default:
      return kClay;
  }
}

Vec3f Shader::heat_color(std::uint32_t id, const Fragment& fragment) const {
  const Corners<float>& v = scene_.values[id];
  const float value = fragment.mix(v[0], v[1], v[2]);
  if (!std::isfinite(value)) return kNoValueColor;
  return heat_light((value - heat_least_) * heat_per_unit_);
}

Vec3f Shader::with_wires(std::uint32_t id, Vec2f at, Vec3f color) const {
  // Each of two neighbours draws its half of the line between them.
  constexpr float kHalfWidth = 0.6F, kRamp = 0.8F;
  const SideDistances sides = side_distances(raster_, id, at);
  const float nearest = std::min({sides.to_side[0], sides.to_side[1], sides.to_side[2]});
  const float on_line = std::clamp((kHalfWidth + kRamp / 2 - nearest) / kRamp, 0.0F, 1.0F);
  const float strength = std::clamp(sides.height / 8, 0.0F, 1.0F);  // or small triangles would be all line
  return color + (kWire - color) * (on_line * strength * 0.85F);
}

Vec3f Shader::color(std::uint32_t id, Vec2f at) const {
  const Fragment fragment = fragment_at(raster_, id, at);
  const bool of_face = options_.shading == Shading::flat || options_.shading == Shading::face_normals;
  const Vec3f normal = normal_at(id, fragment, of_face);
  Vec3f out;
  switch (options_.shading) {
    case Shading::normals:
    case Shading::face_normals:
      out = light_of(normal * 0.5F + Vec3f{0.5F, 0.5F, 0.5F});
      break;
    case Shading::heat:
      // Less shade than elsewhere, as the colours are to be read.
      out = heat_color(id, fragment) * (0.45F + 0.55F * brightness(normal));
      break;
    default: {
      const bool from_behind = fragment.back && !scene_.appearance_of(id).double_sided;
      out = (from_behind ? kBackColor : base_color(id, at, fragment)) * brightness(normal);
    }
  }
  return options_.wireframe ? with_wires(id, at, out) : out;
}

}  // namespace lodestone::render::detail
