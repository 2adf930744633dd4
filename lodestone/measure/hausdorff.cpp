#include "lodestone/measure/hausdorff.h"

#include <algorithm>
#include <cmath>

#include "lodestone/measure/maximum_bound_detail.h"

namespace lodestone::measure {

namespace {

constexpr double kLeastTolerance = 1e-9;  // of the larger diagonal
constexpr std::uint64_t kAnyNumber = std::uint64_t{1} << 60;

HausdorffInterval directed(const spatial::Surface& from, const spatial::Bvh& to, double tolerance, const Task& task) {
  const detail::VertexDistances vertices = detail::vertex_distances(from, to, task);
  if (task.cancelled()) return {};
  const detail::BoundOptions options{0, tolerance, kAnyNumber};
  const detail::MaximumBound bound = detail::bound_maximum(from, to, spatial::triangle_neighbors(to.surface()),
                                                           vertices.of, vertices.peak, options, task);
  return {std::sqrt(bound.peak.distance_sq), bound.upper, bound.peak.at};
}

}  // namespace

Result<Hausdorff> hausdorff(const Model& a, const Model& b, double tolerance, Task task) {
  const Result<spatial::Surface> first = spatial::flatten(a, task), second = first ? spatial::flatten(b, task) : first;
  LODESTONE_TRY(second);
  const double diagonal = std::max(first->bounds.diagonal(), second->bounds.diagonal());
  if (!(tolerance > kLeastTolerance * diagonal)) {
    return fail(ErrorCode::bad_argument, "the tolerance is too small", {}, "use more than 1e-9 of the diagonal");
  }
  const spatial::Bvh first_tree(*first, task), second_tree(*second, task);
  Hausdorff out;
  out.forward = directed(*first, second_tree, tolerance, task.part(0.5));
  out.backward = directed(*second, first_tree, tolerance, task.part(0.5));
  if (task.cancelled()) return cancelled_error("measuring");
  out.lower = std::max(out.forward.lower, out.backward.lower);
  out.upper = std::max(out.forward.upper, out.backward.upper);
  return out;
}

}  // namespace lodestone::measure
