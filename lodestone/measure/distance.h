// Two-sided surface distance by sampling: the figure that every level carries.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/input.h"
#include "lodestone/core/model.h"

namespace lodestone::measure {

struct DistanceOptions {
  std::uint64_t samples = 200'000;  ///< points on each surface, area-weighted and stratified; all vertices come on top
  std::uint64_t seed = 1;
  /// Bound the maximum from above, by subdividing where the distance could be larger than what was found.
  bool bound = true;
  double tolerance = 0.01;     ///< of the maximum: how far the bound may lie above it,
  double least_tolerance = 0;  ///< or this far, model units; 0: 1e-6 of the larger diagonal
  /// Closest points that bounding may look up a direction; 0: one a sample.
  std::uint64_t queries = 0;
  Input input = Input::unchecked;  ///< of the level
};

/// From one surface to the other. Mean, rms and normal angle are over the samples only, the maximum over vertices too.
struct DirectedDistance {
  double max = 0, mean = 0, rms = 0;  ///< model units; max is the largest distance found
  double sampled_max = 0;             ///< largest of the samples and vertices alone, as other tools tell it
  double bound = 0;                   ///< certified: the true maximum is not larger; infinite when not asked for
  Vec3d max_at;                       ///< where on the first surface max was found
  double median = 0, percentile_95 = 0, percentile_99 = 0;  ///< of the samples
  /// Samples by distance, in equal steps from 0 to the largest sample's; that one is in the last. Empty without
  /// samples.
  std::vector<std::uint64_t> histogram;
  double histogram_step = 0;  ///< model units
  double normal_degrees = 0;  ///< mean angle between the faces' normals, 0 to 180
};

struct Distance {
  DirectedDistance forward;   ///< from the original A to B
  DirectedDistance backward;  ///< from B to A
  double max = 0;             ///< the larger of both maxima
  double bound = 0;           ///< the larger of both bounds
  double sampled_max = 0;     ///< the larger of both sampled maxima
  double mean = 0;            ///< half the sum of both means
  double rms = 0;             ///< root of half the sum of both mean squares
  double normal_degrees = 0;  ///< half the sum of both
  double diagonal = 0;        ///< of A's bounding box
  std::uint64_t samples = 0;  ///< a direction

  /// Whether the bound is as near to the maximum as was asked: 1 % (or 1e-6 of the diagonal) unless told otherwise.
  bool is_bounded = false;
  /// The maximum to rely on: the bound where it was reached, else the largest distance found.
  double trusted_max() const { return is_bounded ? bound : max; }

  double relative(double value) const { return diagonal > 0 ? value / diagonal : 0; }
};

/// An original prepared once, so that many levels can be measured against it.
class Reference {
 public:
  /// Flattens the default scene (world space, all instances, bind pose) and builds its tree. Errors: bad_argument
  /// (those of validate()), empty, cancelled.
  static Result<Reference> create(const Model& original, Task task = {});
  Reference(Reference&&) noexcept;
  Reference& operator=(Reference&&) noexcept;
  ~Reference();

  /// Distance between the original and a level. Deterministic for (inputs, samples, seed), any thread count.
  /// O((samples + vertices) log triangles). Errors: bad_argument (those of validate()), empty, cancelled.
  Result<Distance> distance_to(const Model& level, const DistanceOptions& options = {}, Task task = {}) const;

  /// distance_to(), with four times as many samples where a few spots make the whole mean, so that it depends on how
  /// many of the samples hit them: where its relative standard error would be above 1 %. Errors: as distance_to().
  Result<Distance> steady_distance_to(const Model& level, const DistanceOptions& options = {}, Task task = {}) const;

  double diagonal() const;

 private:
  struct Data;
  explicit Reference(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

/// Reference::create(a) and distance_to(b) in one. Errors: as theirs.
Result<Distance> distance(const Model& a, const Model& b, const DistanceOptions& options = {}, Task task = {});

}  // namespace lodestone::measure
