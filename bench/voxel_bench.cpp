// How fast solids are made and contoured, apart: voxelizing at 512 and 1024 along the longest side, shares of 2 x 2 x 2
// voxels at 1024, and the surface of 512³ bytes.
//   voxel_bench MESH… [--benchmark_…]
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "bench/register.h"
#include "lodestone/base/parallel.h"
#include "lodestone/io/read.h"
#include "lodestone/spatial/surface.h"
#include "lodestone/voxel/isosurface.h"
#include "lodestone/voxel/resample.h"
#include "lodestone/voxel/voxelize.h"

namespace {

using namespace lodestone;

void voxelize(benchmark::State& state, const spatial::Surface& surface, std::uint32_t resolution, int threads) {
  const ThreadLimit limit(threads);
  const VoxelGrid grid = *voxel::grid_around(surface.bounds, resolution);
  double slicing = 0, filling = 0;
  for ([[maybe_unused]] const auto& turn : state) {
    const auto made = voxel::voxelize(surface, grid, {}, Task::root({}, threads));
    slicing += made->seconds.slicing;
    filling += made->seconds.filling;
  }
  const auto turns = static_cast<double>(state.iterations());
  state.counters["slicing_ms"] = slicing / turns * 1e3;
  state.counters["filling_ms"] = filling / turns * 1e3;
}

void downsample(benchmark::State& state, const BitVolume& solid, int threads) {
  const ThreadLimit limit(threads);
  const auto& n = solid.grid.size;
  for ([[maybe_unused]] const auto& turn : state) {
    benchmark::DoNotOptimize(voxel::downsample(solid, {n[0] / 2, n[1] / 2, n[2] / 2}, Task::root({}, threads)));
  }
}

void contour(benchmark::State& state, const ScalarVolume<std::uint8_t>& volume, int threads) {
  const ThreadLimit limit(threads);
  std::size_t triangles = 0;
  for ([[maybe_unused]] const auto& turn : state) {
    triangles = voxel::isosurface(volume, {127.5}, Task::root({}, threads))->triangles.size();
  }
  state.counters["triangles"] = static_cast<double>(triangles);
}

// Sums of sines: 3.35 million triangles at 512³.
ScalarVolume<std::uint8_t> gyroid(std::uint32_t n) {
  ScalarVolume<std::uint8_t> out{{{n, n, n}, {}, {1, 1, 1}}, {}};
  out.values.resize(out.grid.count());
  std::vector<double> s(n), c(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    s[i] = std::sin(i * 0.00726);
    c[i] = std::cos(i * 0.00726);
  }
  for (std::uint32_t z = 0; z < n; ++z) {
    for (std::uint32_t y = 0; y < n; ++y) {
      for (std::uint32_t x = 0; x < n; ++x) {
        const double v = s[x] * c[y] + s[y] * c[z] + s[z] * c[x];
        out.values[out.index(x, y, z)] = static_cast<std::uint8_t>(127.5 + 40 * v);
      }
    }
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc < 2) {
    std::fputs("usage: voxel_bench MESH… [--benchmark_…]\n", stderr);
    return 2;
  }
  std::vector<spatial::Surface> surfaces;
  std::vector<BitVolume> solids;
  for (int i = 1; i < argc; ++i) {
    const auto model = io::read_model(argv[i]);
    if (!model) {
      std::fprintf(stderr, "%s\n", model.error().line().c_str());
      return 1;
    }
    surfaces.push_back(*spatial::flatten(*model));
    solids.push_back(voxel::voxelize(surfaces.back(), *voxel::grid_around(surfaces.back().bounds, 1024))->volume);
  }
  const ScalarVolume<std::uint8_t> waves = gyroid(512);
  for (const int threads : {1, 2}) {
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      const std::string name = argv[i + 1];
      for (const std::uint32_t n : {512U, 1024U}) {
        add("voxelize " + std::to_string(n) + " " + name, threads,
            [&surfaces, i, n, threads](benchmark::State& state) { voxelize(state, surfaces[i], n, threads); });
      }
      add("downsample 1024 " + name, threads,
          [&solids, i, threads](benchmark::State& state) { downsample(state, solids[i], threads); });
    }
    add("contour 512 gyroid", threads, [&waves, threads](benchmark::State& state) { contour(state, waves, threads); });
  }
  benchmark::RunSpecifiedBenchmarks();
}
