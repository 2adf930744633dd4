#include "lodestone/simplify/fit/target.h"

#include <numeric>

#include "lodestone/core/model.h"
#include "lodestone/math/triangle.h"

namespace lodestone::simplify {

spatial::Surface surface_of(const Mesh& mesh, const Task& task) {
  Mesh bare;  // attributes are of no use here
  bare.positions = mesh.positions;
  bare.offset = mesh.offset;
  bare.triangles.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) bare.triangles.push_back(mesh.vertices_of(t));
  Result<spatial::Surface> surface = spatial::flatten(make_model(std::move(bare)), Input::valid, task);
  return surface ? std::move(*surface) : spatial::Surface();
}

FitTarget::FitTarget(const Mesh& original, const Task& task, bool centres)
    : original_(&original), surface_(surface_of(original, task)), tree_(surface_, task) {
  const std::size_t n = surface_.positions.size(), triangles = surface_.triangles.size();
  points_ = surface_.positions;
  const std::size_t count = n + (centres ? triangles : 0);
  points_.reserve(count);
  std::vector<double> areas(count, 0.0);
  double sum = 0;
  for (std::size_t t = 0; t < triangles; ++t) {
    const auto [a, b, c] = surface_.corners(t);
    if (centres) points_.push_back((a + b + c) / 3.0);
    const double area = length(scaled_normal(a, b, c)) / 2;
    if (!(area >= 0)) continue;
    sum += area;
    // With three fourths for the centre and the rest for the corners, sums of quadratic functions are exact.
    for (const std::uint32_t v : surface_.triangles[t]) areas[v] += centres ? area / 12 : area / 3;
    if (centres) areas[n + t] = area * 3 / 4;
  }
  weights_.reserve(areas.size());
  for (const double area : areas) weights_.push_back(sum > 0 ? static_cast<float>(area / sum) : 0.0F);
  if (!original.attributes.empty()) find_charts();
}

// Wedges that triangles join are of one chart.
void FitTarget::find_charts() {
  charts_.resize(original_->wedge_count());
  std::iota(charts_.begin(), charts_.end(), 0U);
  const auto root = [&](std::uint32_t w) {
    while (charts_[w] != w) w = charts_[w] = charts_[charts_[w]];
    return w;
  };
  for (const Triangle& t : original_->triangles) {
    for (const std::uint32_t w : t) charts_[root(w)] = root(t[0]);
  }
  for (std::uint32_t w = 0; w < charts_.size(); ++w) charts_[w] = root(w);
}

}  // namespace lodestone::simplify
