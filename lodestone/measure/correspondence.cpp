#include <algorithm>
#include <array>
#include <cmath>

#include "lodestone/base/parallel.h"
#include "lodestone/math/triangle.h"
#include "lodestone/measure/correspondence_detail.h"
#include "lodestone/measure/sampling_detail.h"

namespace lodestone::measure::detail {

namespace {

constexpr std::size_t kChunk = 4096;
constexpr double kReach = 0.01;  // of the diagonal: how much farther a triangle that faces the right way may be

// Finds partners on one surface; one for each chunk of samples.
class Finder {
 public:
  explicit Finder(const spatial::Bvh& tree) : tree_(tree) {
    const Box3d& box = tree.surface().bounds;
    diagonal_ = box.diagonal();
    // Distances that only rounding tells apart: of the sizes that went into them.
    const Vec3d far{std::max(std::abs(box.min.x), std::abs(box.max.x)),
                    std::max(std::abs(box.min.y), std::abs(box.max.y)),
                    std::max(std::abs(box.min.z), std::abs(box.max.z))};
    rounding_ = 1e-12 * diagonal_ + 1e-15 * length(far);
  }

  spatial::Nearest partner(Vec3d p, Vec3d normal) {
    const spatial::Nearest nearest = tree_.closest(p, hint_);
    hint_ = nearest.triangle;
    const double distance = std::sqrt(nearest.distance_sq);
    near_.clear();
    tree_.all_within(p, distance + rounding_ + 1e-15 * distance, near_);
    const spatial::Nearest best = best_facing(nearest, normal);
    if (facing(best, normal) > 0) return best;
    const spatial::Nearest other = tree_.closest_facing(p, normal, distance + kReach * diagonal_);
    return other.triangle == kNone ? best : other;
  }

 private:
  // Cosine between the triangle's normal and `normal`; 0 for a triangle without area.
  double facing(const spatial::Nearest& found, Vec3d normal) const {
    const auto [a, b, c] = tree_.surface().corners(found.triangle);
    return dot(normalized(scaled_normal(a, b, c)), normal);
  }

  spatial::Nearest best_facing(const spatial::Nearest& nearest, Vec3d normal) const {
    spatial::Nearest best = nearest;
    double best_cosine = facing(best, normal);
    for (const spatial::Nearest& other : near_) {
      if (other.triangle == best.triangle) continue;
      const double cosine = facing(other, normal);
      if (cosine > best_cosine + 1e-12 || (cosine > best_cosine - 1e-12 && is_nearer(other, best))) {
        best = other;
        best_cosine = cosine;
      }
    }
    return best;
  }

  static bool is_nearer(const spatial::Nearest& a, const spatial::Nearest& b) {
    return a.distance_sq != b.distance_sq ? a.distance_sq < b.distance_sq : a.triangle < b.triangle;
  }

  const spatial::Bvh& tree_;
  double diagonal_ = 0, rounding_ = 0;
  std::uint32_t hint_ = kNone;
  std::vector<spatial::Nearest> near_;
};

}  // namespace

std::vector<Pair> corresponding_points(const spatial::Surface& from, const spatial::Bvh& to, std::uint64_t samples,
                                       std::uint64_t seed, const Task& task) {
  const Sampler sampler(from, samples, seed);
  std::vector<Pair> pairs(sampler.count());
  parallel_for(pairs.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    Finder finder(to);
    sampler.for_each(begin, end, [&](std::size_t i, const Sample& sample) {
      const auto [a, b, c] = from.corners(sample.triangle);
      const spatial::Nearest found = finder.partner(sample.point, normalized(scaled_normal(a, b, c)));
      const auto [d, e, f] = to.surface().corners(found.triangle);
      const std::array<double, 3> weights = barycentric(found.point, d, e, f);
      pairs[i] = {{sample.triangle, sample.weights[1], sample.weights[2]}, {found.triangle, weights[1], weights[2]}};
    });
    task.advance(static_cast<double>(end - begin) / static_cast<double>(pairs.size()));
  });
  return pairs;
}

}  // namespace lodestone::measure::detail
