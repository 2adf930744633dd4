// Two-sided surface distance by sampling: the figure that every level carries.
#pragma once

#include <cstdint>
#include <memory>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"

namespace lodestone::measure {

struct DistanceOptions {
  std::uint64_t samples = 200'000;  ///< points on each surface, area-weighted and stratified; all vertices come on top
  std::uint64_t seed = 1;
  /// Subdivide the surface around the worst samples until the maximum moves by less than 1 %.
  bool sharpen = true;
};

/// From one surface to the other. Mean, rms and normal angle are over the samples only, the maximum over vertices too.
struct DirectedDistance {
  double max = 0, mean = 0, rms = 0;  ///< model units; max is sharpened when asked for
  double sampled_max = 0;             ///< largest of the samples and vertices alone, as other tools tell it
  Vec3d max_at;                       ///< where on the first surface
  double normal_degrees = 0;          ///< mean angle between the faces' normals, 0 to 180
};

struct Distance {
  DirectedDistance forward;   ///< from the original A to B
  DirectedDistance backward;  ///< from B to A
  double max = 0;             ///< the larger of both maxima
  double sampled_max = 0;     ///< the larger of both sampled maxima
  double mean = 0;            ///< half the sum of both means
  double rms = 0;             ///< root of half the sum of both mean squares
  double normal_degrees = 0;  ///< half the sum of both
  double diagonal = 0;        ///< of A's bounding box
  std::uint64_t samples = 0;  ///< a direction

  double relative(double value) const { return diagonal > 0 ? value / diagonal : 0; }
};

/// An original prepared once, so that many levels can be measured against it.
class Reference {
 public:
  /// Flattens the default scene (world space, all instances, bind pose) and builds its tree. Errors: empty, cancelled.
  static Result<Reference> create(const Model& original, Task task = {});
  Reference(Reference&&) noexcept;
  Reference& operator=(Reference&&) noexcept;
  ~Reference();

  /// Distance between the original and a level. Deterministic for (inputs, samples, seed), any thread count.
  /// O((samples + vertices) log triangles). Errors: empty, cancelled.
  Result<Distance> distance_to(const Model& level, const DistanceOptions& options = {}, Task task = {}) const;

  double diagonal() const;

 private:
  struct Data;
  explicit Reference(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

/// Reference::create(a) and distance_to(b) in one.
Result<Distance> distance(const Model& a, const Model& b, const DistanceOptions& options = {}, Task task = {});

}  // namespace lodestone::measure
