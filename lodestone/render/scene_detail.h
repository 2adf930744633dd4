// What a Scene holds: the surface, and beside it what each corner of each triangle carries.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lodestone/math/box.h"
#include "lodestone/math/vec.h"
#include "lodestone/render/mip_texture_detail.h"
#include "lodestone/render/packed_normal_detail.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::render::detail {

template <class T>
using Corners = std::array<T, 3>;

/// Red, green, blue and alpha as light, 1 = 65535.
using PackedColor = std::array<std::uint16_t, 4>;

/// How the triangles of one material look.
struct Appearance {
  Vec3f color{1, 1, 1};  ///< base colour factor, light
  float alpha = 1;
  float alpha_cutoff = 0;               ///< below it nothing is drawn; 0 = all is
  const MipTexture* texture = nullptr;  ///< null = none
  bool missing = false;                 ///< there should be a texture, and there are no pixels
  bool double_sided = false;
};

struct SceneData {
  spatial::Surface surface;
  Box3d bounds;                            ///< of the finite positions
  std::vector<std::uint32_t> first_drawn;  ///< of each instance, its first triangle among all drawn; and the end

  // One entry a triangle of the surface, its corners in the surface's order. Empty where nothing drawn has them.
  std::vector<Corners<PackedNormal>> normals;  ///< never empty
  std::vector<Corners<Vec2f>> uvs;             ///< after the material's texture transform, origin at the top
  std::vector<Corners<PackedColor>> colors;    ///< vertex colours
  std::vector<Corners<float>> values;          ///< heat; NaN = none
  std::vector<std::uint32_t> appearance;       ///< index into `appearances`; empty = all 0
  std::vector<Appearance> appearances;         ///< of each material, then of what has none
  bool masked = false;                         ///< some appearance has an alpha cutoff

  std::vector<std::unique_ptr<const MipTexture>> textures;
  float least_value = 0, largest_value = 0;
  std::vector<std::string> notes;

  const Appearance& appearance_of(std::uint32_t triangle) const {
    return appearances[appearance.empty() ? 0 : appearance[triangle]];
  }
};

}  // namespace lodestone::render::detail
