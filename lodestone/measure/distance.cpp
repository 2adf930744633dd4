#include "lodestone/measure/distance.h"

#include <algorithm>
#include <cmath>

#include "lodestone/measure/directed_detail.h"

namespace lodestone::measure {

struct Reference::Data {
  spatial::Surface surface;
  spatial::Bvh tree;

  Data(spatial::Surface s, const Task& task) : surface(std::move(s)), tree(surface, task) {}
};

Reference::Reference(std::unique_ptr<Data> data) : data_(std::move(data)) {}
Reference::Reference(Reference&&) noexcept = default;
Reference& Reference::operator=(Reference&&) noexcept = default;
Reference::~Reference() = default;

Result<Reference> Reference::create(const Model& original, Task task) {
  Result<spatial::Surface> surface = spatial::flatten(original, task);
  LODESTONE_TRY(surface);
  auto data = std::make_unique<Data>(std::move(*surface), task);
  if (task.cancelled()) return cancelled_error("measuring");
  return Reference(std::move(data));
}

double Reference::diagonal() const { return data_->surface.bounds.diagonal(); }

Result<Distance> Reference::distance_to(const Model& level, const DistanceOptions& options, Task task) const {
  const Result<spatial::Surface> surface = spatial::flatten(level, options.input, task);
  LODESTONE_TRY(surface);
  const spatial::Bvh tree(*surface, task);
  Distance out;
  out.forward = detail::directed_distance(data_->surface, tree, options, task.part(0.5));
  out.backward = detail::directed_distance(*surface, data_->tree, options, task.part(0.5));
  if (task.cancelled()) return cancelled_error("measuring");
  out.max = std::max(out.forward.max, out.backward.max);
  out.bound = std::max(out.forward.bound, out.backward.bound);
  out.is_bounded = out.bound <= detail::bound_goal(out.max, std::max(diagonal(), surface->bounds.diagonal()), options);
  out.sampled_max = std::max(out.forward.sampled_max, out.backward.sampled_max);
  out.mean = (out.forward.mean + out.backward.mean) / 2;
  out.rms = std::sqrt((out.forward.rms * out.forward.rms + out.backward.rms * out.backward.rms) / 2);
  out.normal_degrees = (out.forward.normal_degrees + out.backward.normal_degrees) / 2;
  out.diagonal = diagonal();
  out.samples = options.samples;
  return out;
}

// The limit is that of independent samples; stratified ones do better.
Result<Distance> Reference::steady_distance_to(const Model& level, const DistanceOptions& options, Task task) const {
  Result<Distance> d = distance_to(level, options, task.part(0.5));
  constexpr double kSteady = 0.01, kNothing = 1e-7;
  if (!d || d->mean <= kNothing * d->diagonal) return d;
  const double spread = d->rms / d->mean;
  if (spread * spread - 1 <= kSteady * kSteady * static_cast<double>(d->samples)) return d;
  DistanceOptions more = options;
  more.samples *= 4;
  return distance_to(level, more, task.part(0.5));
}

Result<Distance> distance(const Model& a, const Model& b, const DistanceOptions& options, Task task) {
  const Result<Reference> reference = Reference::create(a, task.part(0.1));
  LODESTONE_TRY(reference);
  return reference->distance_to(b, options, task);
}

}  // namespace lodestone::measure
