// How far apart two models' attributes are at corresponding points: normals, UVs, vertex colours, and the colour that a
// viewer shows.
//
// Definitions. M1 is the model that is sampled, M2 the other; p1 is a sample on M1 and p2 the point on M2 that
// corresponds to it. Distances are those of [lod-survey], section "attribute errors":
//   normal   d_n = angle between n1 and n2, degrees, 0 to 180
//   UV       d_t = sqrt((u1 - u2)^2 + (v1 - v2)^2), as stored, origin at the image's top
//   colour   d_c = sqrt((r1 - r2)^2 + (g1 - g2)^2 + (b1 - b2)^2), channels in [0, 1], so white to black is sqrt(3)
//   look     d_c of the colours on the screen: base colour factor x texture x vertex colour, multiplied as light,
//            compared in sRGB. Texture: UVs after KHR_texture_transform, bilinear, repeating, in full resolution.
//            Without lights, alpha and other textures.
//
// Samples are those of distance.h: area-weighted, stratified, world space, bind pose, the same for the same seed; both
// ways. Values within a triangle are interpolated between its corners.
//
// Corresponding point. Let d be p1's distance to M2.
//   1. Of the triangles that are as near as d (but for rounding: a sample beside a convex edge is equally near to both
//      its triangles), the one whose normal is closest to that of p1's triangle is taken.
//   2. Where that one faces the other way (90 degrees or more; the far side of a thin sheet, say), the nearest triangle
//      that doesn't is taken instead, if it is no farther than d + 1 % of M2's diagonal.
// The rule looks at shape alone, never at the attributes that it is to judge.
//
// Seams. Where two charts of an atlas meet, the slightest shift of the seam pairs points of both charts. d_t is then
// the distance between two places in the atlas and says nothing about what is seen. So `look` is the figure to judge by
// where there are textures. Of UVs the median and the 95th percentile stand beside the mean, as a narrow band along the
// seams does not reach them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"

namespace lodestone::measure {

struct AttributeOptions {
  std::uint64_t samples = 200'000;      ///< points on each surface
  std::uint64_t seed = 1;               ///< the same points as distance() has
  std::optional<std::uint32_t> uv_set;  ///< this set alone, which both models must have; without: all that both have
};

/// Distances of one attribute. All 0 where nothing could be compared.
struct Deviation {
  double mean = 0, rms = 0, max = 0;
  double median = 0, percentile_95 = 0;
  double share = 0;  ///< of the samples: those at which both models have a finite value
};

struct AttributeFigure {
  Deviation forward;   ///< samples on A
  Deviation backward;  ///< samples on B
  /// Both ways: mean = half the sum of both means, rms = root of half the sum of both mean squares, the larger maximum,
  /// percentiles and share of all samples. A direction in which nothing could be compared is left out.
  Deviation both;
};

struct UvFigure {
  std::uint32_t set = 0;
  AttributeFigure distance;
  double diagonal = 0;  ///< of the box of A's UVs

  double relative(double value) const { return diagonal > 0 ? value / diagonal : 0; }
};

struct Attributes {
  /// By the normal streams; a face's own normal where there is none, as a viewer would draw it. Degrees.
  AttributeFigure normal;
  std::vector<UvFigure> uv;              ///< one a set that both have, rising
  std::optional<AttributeFigure> color;  ///< COLOR_0, where both have it
  std::optional<AttributeFigure> look;   ///< where anything but plain white is drawn by either
  std::uint64_t samples = 0;             ///< a direction
  std::vector<std::string> notes;        ///< what only one of them has, textures that are missing: for the user
};

/// Compares A, the original, with B. Textures count where they are decoded (io::decode_base_colors); those that aren't
/// count as white and are told. Deterministic for (inputs, samples, seed), any thread count. O((samples + triangles)
/// log triangles), some 60 bytes a sample. Errors: empty, bad_argument (uv_set is not there; says which are; those
/// of validate()), cancelled.
Result<Attributes> attribute_deviation(const Model& a, const Model& b, const AttributeOptions& options = {},
                                       Task task = {});

}  // namespace lodestone::measure
