// Materials and images, as far as our own writers, the renderer and the baker need them. A glTF document keeps its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lodestone/core/pixels.h"

namespace lodestone {

/// An image file as found, not decoded.
struct Image {
  std::string name;                ///< file name as the model said
  std::string mime;                ///< "image/png", "image/jpeg", …
  std::vector<std::byte> encoded;  ///< the file's bytes; empty when it was missing (then a warning was given)
};

/// Where a material's texture looks: (u, v) of a set, then the affine map of KHR_texture_transform.
struct TextureCoordinates {
  std::uint32_t set = 0;
  std::array<double, 6> map{1, 0, 0, 0, 1, 0};  ///< u' = m0 u + m1 v + m2, v' = m3 u + m4 v + m5
};

/// A line of an MTL that no field of Material holds, as it was. That of a texture ends before the file's name.
struct MtlLine {
  std::string text;                      ///< "illum 2", "map_Bump -bm 0.5"
  std::shared_ptr<const Image> texture;  ///< null: the line is whole
};

struct Material {
  std::string name;
  std::array<float, 4> base_color{1, 1, 1, 1};  ///< linear RGBA factor
  float metallic = 0;
  float roughness = 1;
  std::shared_ptr<const Image> base_color_texture;  ///< may be null
  TextureCoordinates base_color_coordinates;
  /// The texture decoded; null until io::decode_base_colors() was asked for it, or where it can't be decoded.
  std::shared_ptr<const Pixels> base_color_pixels;
  /// Tangent space, +Y up as in glTF; looks where set 0 says. May be null. Kept for writing: readers of glTF leave it
  /// to the document, and nothing is drawn with it.
  std::shared_ptr<const Image> normal_texture;
  bool double_sided = false;
  float alpha_cutoff = 0;  ///< nothing is drawn where alpha is below it (glTF's MASK); 0 = no mask
  bool blend = false;      ///< the texture's alpha lets shine through what lies behind (glTF's BLEND)
  /// What else an MTL said, for writing MTL; writing glTF takes from it what glTF holds.
  std::vector<MtlLine> mtl_lines;
};

}  // namespace lodestone
