// Texture coordinates for a surface that has none.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"

namespace lodestone::bake {

struct AtlasOptions {
  std::uint32_t texture_size = 1024;  ///< width and height of the texture that the gutters are for, 16 to 16384
  std::uint32_t gutter_texels = 4;    ///< between any two charts; half of it along the texture's border
};

struct Atlas {
  /// The target with TEXCOORD_0, the origin at the image's top left (Model::uv_origin_top). Vertices, triangles and
  /// their order are the target's; a wedge is split only where charts meet, so that a vertex that one chart surrounds
  /// keeps what it has. Tangents, which would be stale, are left out; other streams stay.
  Mesh mesh;
  std::vector<std::uint32_t> chart;  ///< one a triangle, below `charts`
  std::uint32_t charts = 0;
  double used = 0;             ///< share of the texture that triangles cover
  double texels_per_unit = 0;  ///< along a chart's plane
};

/// Cuts the target into charts that are nearly flat, lays each out by a projection along its mean normal, and packs
/// them into one square. No two triangles overlap; none is turned over; a triangle that is tilted against its chart's
/// plane gets less texels, at worst a fifth, usually more than half. Same bytes for any thread count. O(n log n).
/// Errors: empty (no triangle), bad_argument (a size out of range; too many charts for the texture's gutters; those of
/// validate(), of the target), cancelled.
Result<Atlas> make_atlas(const Mesh& target, const AtlasOptions& options = {}, Task task = {});

}  // namespace lodestone::bake
