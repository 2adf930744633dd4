#include <algorithm>
#include <cmath>

#include "app/samples/noise.h"
#include "app/samples/samples.h"
#include "lodestone/base/parallel.h"

namespace lodestone::app {
namespace {

constexpr double kSize = 2000, kHeight = 420;  // metres

struct Grid {
  std::size_t columns, rows;
};

// Cells nearly square, 2 * columns * rows nearest to `triangles`.
Grid grid_for(std::size_t triangles) {
  const std::size_t cells = std::max<std::size_t>(1, (triangles + 1) / 2);
  const auto root = static_cast<std::size_t>(std::sqrt(static_cast<double>(cells)));
  Grid best{std::max<std::size_t>(1, root), 0};
  std::size_t best_gap = cells + 1;
  for (std::size_t columns = std::max<std::size_t>(1, root); columns >= 1 && columns * 2 >= root && best_gap > 0;
       --columns) {
    const std::size_t rows = (cells + columns / 2) / columns;
    const std::size_t made = columns * rows;
    const std::size_t gap = made > cells ? made - cells : cells - made;
    if (rows > 0 && gap < best_gap) {
      best = Grid{columns, rows};
      best_gap = gap;
    }
  }
  return best;
}

// Ridges that rise out of rolling lowland, cut by a valley.
double height_at(double x, double z, std::uint64_t seed) {
  const Vec3d p{x / kSize, 0.5, z / kSize};
  const double bend = 0.15 * gradient_noise(p * 2.0, seed + 100);
  const double land = 0.5 + 0.5 * fractal_noise(p * 2.0, 4, 0.5, seed + 200);
  const double ridges = ridged_noise(p * 3.0 + Vec3d{bend, 0, bend}, 9, 0.5, seed + 300);
  const double across = p.x - 0.5 + bend;
  const double valley = smooth_step(0, 0.35, across < 0 ? -across : across);
  return kHeight * (0.25 * land + (0.15 + 0.85 * valley) * 0.75 * ridges * ridges);
}

}  // namespace

Model make_terrain(std::size_t triangles, std::uint64_t seed, const Task& task) {
  const Grid grid = grid_for(triangles);
  const std::size_t across = grid.columns + 1, vertices = across * (grid.rows + 1);
  Mesh mesh;
  mesh.name = "terrain";
  mesh.positions.resize(vertices);
  mesh.attributes.push_back(make_stream("TEXCOORD_0", Semantic::uv, 2, ComponentType::float32, false, vertices));
  auto& uv = std::get<std::vector<float>>(mesh.attributes[0].values);
  constexpr std::size_t kVerticesAtOnce = 4096;
  parallel_for(vertices, kVerticesAtOnce, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const double u = static_cast<double>(i % across) / static_cast<double>(grid.columns);
      const double v = static_cast<double>(i / across) / static_cast<double>(grid.rows);
      mesh.positions[i] = to_float(Vec3d{(u - 0.5) * kSize, height_at(u * kSize, v * kSize, seed), (v - 0.5) * kSize});
      uv[2 * i] = static_cast<float>(u);
      uv[2 * i + 1] = static_cast<float>(v);
    }
    task.advance(static_cast<double>(end - begin) / static_cast<double>(vertices));
  });
  mesh.triangles.reserve(2 * grid.columns * grid.rows);
  for (std::size_t row = 0; row < grid.rows && !task.cancelled(); ++row) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const auto a = static_cast<std::uint32_t>(row * across + column);
      const auto c = static_cast<std::uint32_t>(a + across);
      mesh.triangles.push_back(Triangle{a, c, a + 1});
      mesh.triangles.push_back(Triangle{a + 1, c, c + 1});
    }
  }
  Model model = make_model(std::move(mesh));
  model.meters_per_unit = 1;
  return model;
}

}  // namespace lodestone::app
