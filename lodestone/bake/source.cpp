#include "lodestone/bake/source.h"

#include <cmath>
#include <vector>

#include "lodestone/math/triangle.h"
#include "lodestone/spatial/bvh.h"
#include "lodestone/spatial/closest_batch.h"
#include "lodestone/spatial/smooth_normals.h"

namespace lodestone::bake {

using spatial::Nearest;
using spatial::SurfacePoint;

namespace {

constexpr double kReach = 0.01;  // of the diagonal: how much farther a place that faces the right way may be

// True where every drawn triangle has a normal stream.
bool all_have_normals(const Model& model) {
  for (const Instance& instance : model.instances) {
    const AttributeStream* stream = find_stream(model.meshes[instance.mesh], Semantic::normal);
    if (stream == nullptr || !stream->present.empty()) return false;
  }
  return true;
}

}  // namespace

struct BakeSource::Data {
  spatial::Surface surface;
  spatial::Bvh tree;
  spatial::DrawnAttributes attributes;
  std::optional<spatial::CreaseNormals> normals;  // none where the model has its own everywhere
  double reach;

  Data(const Model& model, spatial::Surface made, const Task& task)
      : surface(std::move(made)),
        tree(surface, task),
        attributes(model, surface),
        reach(kReach * surface.bounds.diagonal()) {
    if (!all_have_normals(model)) normals.emplace(surface, task);
  }
};

Result<BakeSource> BakeSource::create(const Model& model, Task task) {
  task = task.part(1, "source of attributes");
  Result<spatial::Surface> surface = spatial::flatten(model, task);
  LODESTONE_TRY(surface);
  auto data = std::make_shared<const Data>(model, std::move(*surface), task);
  if (task.cancelled()) return cancelled_error("baking");
  return BakeSource(std::move(data));
}

void BakeSource::find(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                      std::span<SurfacePoint> places) const {
  std::vector<Nearest> closest(points.size());
  spatial::ClosestBatch(data_->tree).find(points, closest);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Nearest found = closest[i];
    const auto [a, b, c] = data_->surface.corners(found.triangle);
    if (!(dot(scaled_normal(a, b, c), normals[i]) > 0) && normals[i] != Vec3d{}) {
      const Nearest other =
          data_->tree.closest_facing(points[i], normals[i], std::sqrt(found.distance_sq) + data_->reach);
      if (other.triangle != kNone) found = other;
    }
    const auto [d, e, f] = data_->surface.corners(found.triangle);
    const std::array<double, 3> weights = barycentric(found.point, d, e, f);
    places[i] = {found.triangle, weights[1], weights[2]};
  }
}

Vec3d BakeSource::point(const SurfacePoint& place) const {
  const auto [a, b, c] = data_->surface.corners(place.triangle);
  const std::array<double, 3> w = place.weights();
  return a * w[0] + b * w[1] + c * w[2];
}

Vec3d BakeSource::normal(const SurfacePoint& place) const {
  if (const std::optional<Vec3d> own = data_->attributes.stream_normal(place)) return *own;
  if (!data_->normals) return data_->attributes.normal(place).value_or(Vec3d{});
  const std::array<double, 3> w = place.weights();
  Vec3d sum{};
  for (std::size_t k = 0; k < 3; ++k) sum += data_->normals->at(place.triangle, k) * w[k];
  return normalized(sum);
}

Vec3d BakeSource::color(const SurfacePoint& place) const { return data_->attributes.light(place); }

bool BakeSource::has_color() const { return data_->attributes.has_appearance(); }

const spatial::Surface& BakeSource::surface() const { return data_->surface; }

}  // namespace lodestone::bake
