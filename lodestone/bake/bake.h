// Textures for a surface, taken from another one.
#pragma once

#include <cstdint>

#include "lodestone/bake/source.h"
#include "lodestone/core/pixels.h"

namespace lodestone::bake {

struct BakeOptions {
  std::uint32_t texture_size = 1024;  ///< width and height, 16 to 16384
  bool base_color = true;             ///< nothing where the source is plain white
  bool normal_map = true;
  /// Along each side of a texel, 1 to 8: their mean is written. 1 is sharpest and fastest; more serve where the source
  /// has finer detail than the texels.
  std::uint32_t samples_per_side = 1;
  std::uint32_t gutter_texels = 8;  ///< how far colours are carried on around charts; beyond is their mean
};

struct Baked {
  /// The target with unit normals (its own stream where it has one, else smooth ones) and tangents (4 floats), to which
  /// the normal map refers.
  Mesh mesh;
  Pixels base_color;         ///< sRGB, opaque; empty where not asked for or the source is plain white
  Pixels normal_map;         ///< tangent space, +Y up as in glTF; empty where not asked for
  double covered = 0;        ///< share of the texels whose centre a triangle covers
  double mean_distance = 0;  ///< from covered texels to where on the source they looked, model units
  double max_distance = 0;
};

/// For each texel that a triangle of the target covers, finds points of it on the target, the places of the source
/// that BakeSource::find() gives for these, and writes the mean of what is there. The target lies in the source's world
/// space and has TEXCOORD_0, the origin at the image's top left, within [0, 1] and without overlaps as make_atlas()
/// makes it; of triangles that overlap the first wins. Texels up to one and a half beside a chart, which bilinear
/// filters read, are taken at the chart's nearest point; farther ones are copies. Where the source's normal points
/// against the target's, the target's is taken. Same bytes for any thread count. O(texels x samples_per_side squared x
/// log source), 24 bytes a texel. Errors: empty (no triangle), bad_argument (no texture coordinates, a size out of
/// range; those of validate(), of the target), cancelled.
Result<Baked> bake_textures(const Mesh& target, const BakeSource& source, const BakeOptions& options = {},
                            Task task = {});

}  // namespace lodestone::bake
