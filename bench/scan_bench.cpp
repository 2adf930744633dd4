// How fast scans become surfaces: a million points at random on each mesh; nearest neighbours, normals, and both ways
// to a volume of 256 along the longest side.
//   scan_bench MESH… [--benchmark_…]
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/register.h"
#include "lodestone/base/parallel.h"
#include "lodestone/base/random.h"
#include "lodestone/io/read.h"
#include "lodestone/points/normals.h"
#include "lodestone/spatial/kd_tree.h"
#include "lodestone/spatial/surface.h"
#include "lodestone/voxel/scan.h"

namespace {

using namespace lodestone;

constexpr std::size_t kPoints = 1000000;

// In no order, as the worst scanners give them.
PointCloud scan(const spatial::Surface& surface) {
  std::vector<double> area_before;
  double sum = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    sum += length(cross(b - a, c - a));
    area_before.push_back(sum);
  }
  PointCloud cloud;
  for (std::uint64_t i = 0; i < kPoints; ++i) {
    const auto found = std::lower_bound(area_before.begin(), area_before.end(), random_unit(1, 3 * i) * sum);
    const auto t = static_cast<std::size_t>(found - area_before.begin());
    double u = random_unit(1, 3 * i + 1), v = random_unit(1, 3 * i + 2);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const auto [a, b, c] = surface.corners(std::min(t, surface.triangles.size() - 1));
    cloud.positions.push_back(to_float(a + (b - a) * u + (c - a) * v));
  }
  return cloud;
}

void neighbors(benchmark::State& state, const PointCloud& cloud, int threads) {
  const ThreadLimit limit(threads);
  const Task task = Task::root({}, threads);
  std::vector<float> farthest(cloud.size());
  for ([[maybe_unused]] const auto& turn : state) {
    const spatial::KdTree tree(cloud.positions, task);
    tree.each_neighborhood(16, task, [&](std::uint32_t point, std::span<const spatial::Neighbor> near) {
      farthest[point] = static_cast<float>(near.back().distance_sq);
    });
  }
}

void normals(benchmark::State& state, const PointCloud& cloud, int threads) {
  const ThreadLimit limit(threads);
  for ([[maybe_unused]] const auto& turn : state) {
    benchmark::DoNotOptimize(points::estimate_normals(cloud, {}, Task::root({}, threads)));
  }
}

void solid(benchmark::State& state, const PointCloud& cloud, int threads) {
  const ThreadLimit limit(threads);
  for ([[maybe_unused]] const auto& turn : state) {
    benchmark::DoNotOptimize(voxel::scan_solid(cloud, {}, Task::root({}, threads)));
  }
}

void distance(benchmark::State& state, const PointCloud& cloud, int threads) {
  const ThreadLimit limit(threads);
  for ([[maybe_unused]] const auto& turn : state) {
    benchmark::DoNotOptimize(voxel::scan_distance(cloud, {}, Task::root({}, threads)));
  }
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc < 2) {
    std::fputs("usage: scan_bench MESH… [--benchmark_…]\n", stderr);
    return 2;
  }
  std::vector<PointCloud> clouds;
  for (int i = 1; i < argc; ++i) {
    const auto model = io::read_model(argv[i]);
    if (!model) {
      std::fprintf(stderr, "%s\n", model.error().line().c_str());
      return 1;
    }
    clouds.push_back(scan(*spatial::flatten(*model)));
    clouds.back().normals = points::estimate_normals(clouds.back())->normals;
  }
  for (const int threads : {1, 2}) {
    for (std::size_t i = 0; i < clouds.size(); ++i) {
      const PointCloud& cloud = clouds[i];
      const std::string name = argv[i + 1];
      add("16 neighbors " + name, threads,
          [&cloud, threads](benchmark::State& state) { neighbors(state, cloud, threads); });
      add("normals " + name, threads, [&cloud, threads](benchmark::State& state) { normals(state, cloud, threads); });
      add("solid 256 " + name, threads, [&cloud, threads](benchmark::State& state) { solid(state, cloud, threads); });
      add("distance 256 " + name, threads,
          [&cloud, threads](benchmark::State& state) { distance(state, cloud, threads); });
    }
  }
  benchmark::RunSpecifiedBenchmarks();
}
