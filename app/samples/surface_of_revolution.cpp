#include "app/samples/surface_of_revolution.h"

#include <algorithm>
#include <cmath>

#include "lodestone/base/parallel.h"

namespace lodestone::app {
namespace {

std::size_t even_count(std::size_t triangles) { return std::max<std::size_t>(6, (triangles + 1) / 2 * 2); }

double average_around(const RevolutionProfile& profile) {
  constexpr int kSteps = 1000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += profile.around((i + 0.5) / kSteps);
  return sum / kSteps;
}

// Triangles between ring vertices [low, low + a) and [high, high + b). Every second ring is turned by half a step.
void zip_rings(std::vector<Triangle>& out, std::uint32_t low, std::uint32_t a, std::uint32_t low_phase,
               std::uint32_t high, std::uint32_t b, std::uint32_t high_phase) {
  std::uint64_t i = 0, j = 0;
  const auto at = [](std::uint32_t first, std::uint64_t k, std::uint32_t n) {
    return first + static_cast<std::uint32_t>(k % n);
  };
  while (i < a || j < b) {
    const bool low_is_next = j == b || (i < a && (2 * i + 2 + low_phase) * b <= (2 * j + 2 + high_phase) * a);
    if (low_is_next) {
      out.push_back(Triangle{at(low, i, a), at(low, i + 1, a), at(high, j, b)});
      ++i;
    } else {
      out.push_back(Triangle{at(low, i, a), at(high, j + 1, b), at(high, j, b)});
      ++j;
    }
  }
}

}  // namespace

RevolutionPlan plan_rings(std::size_t triangles, const RevolutionProfile& profile) {
  const std::size_t half = even_count(triangles) / 2;  // vertices on all rings
  // Equilateral triangles of side s: rings are s * sqrt(3) / 2 apart, and a triangle covers s^2 * sqrt(3) / 4.
  const double root3 = std::sqrt(3.0);
  const double area = average_around(profile) * profile.length;
  const double side = std::sqrt(2 * area / (root3 * static_cast<double>(half)));
  const auto wanted = static_cast<std::size_t>(profile.length / (side * root3 / 2));
  const std::size_t rings = std::clamp<std::size_t>(wanted, 1, half / 3);

  RevolutionPlan plan;
  std::vector<double> weights;
  double total = 0;
  for (std::size_t i = 0; i < rings; ++i) {
    plan.places.push_back(static_cast<double>(i + 1) / static_cast<double>(rings + 1));
    weights.push_back(profile.around(plan.places.back()));
    total += weights.back();
  }
  const std::size_t spare = half - 3 * rings;
  double sum = 0;
  std::size_t given = 0;
  for (std::size_t i = 0; i < rings; ++i) {
    sum += weights[i];
    const std::size_t until =
        i + 1 == rings ? spare : static_cast<std::size_t>(static_cast<double>(spare) * (sum / total));
    plan.counts.push_back(static_cast<std::uint32_t>(3 + until - given));
    given = until;
  }
  return plan;
}

Mesh stack_rings(const RevolutionPlan& plan, const RingSurface& surface, const Task& task) {
  std::vector<std::uint32_t> first;  // vertex of each ring; vertex 0 is the lower pole
  std::uint32_t next = 1;
  for (const std::uint32_t count : plan.counts) {
    first.push_back(next);
    next += count;
  }
  Mesh mesh;
  mesh.positions.resize(std::size_t{next} + 1);
  mesh.triangles.reserve(2 * (std::size_t{next} - 1));

  mesh.positions.front() = to_float(surface(0, 0));
  mesh.positions.back() = to_float(surface(1, 0));
  const std::size_t rings = plan.counts.size();
  constexpr std::size_t kRingsAtOnce = 4;
  parallel_for(rings, kRingsAtOnce, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t r = begin; r < end; ++r) {
      for (std::uint32_t k = 0; k < plan.counts[r]; ++k) {
        const double turns = (k + 0.5 * static_cast<double>(r % 2)) / plan.counts[r];
        mesh.positions[first[r] + k] = to_float(surface(plan.places[r], turns));
      }
    }
    task.advance(static_cast<double>(end - begin) / static_cast<double>(rings));
  });

  const auto phase = [](std::size_t ring) { return static_cast<std::uint32_t>(ring % 2); };
  const std::uint32_t bottom_count = plan.counts.front(), top_count = plan.counts.back();
  for (std::uint32_t k = 0; k < bottom_count; ++k) {
    mesh.triangles.push_back(Triangle{0, first[0] + (k + 1) % bottom_count, first[0] + k});
  }
  for (std::size_t r = 0; r + 1 < rings && !task.cancelled(); ++r) {
    zip_rings(mesh.triangles, first[r], plan.counts[r], phase(r), first[r + 1], plan.counts[r + 1], phase(r + 1));
  }
  const auto top = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  for (std::uint32_t k = 0; k < top_count; ++k) {
    mesh.triangles.push_back(Triangle{first.back() + k, first.back() + (k + 1) % top_count, top});
  }
  return mesh;
}

}  // namespace lodestone::app
