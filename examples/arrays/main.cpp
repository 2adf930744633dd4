// Arrays in, a ladder with progress and a way to stop, arrays out: what an engine or a tool of its own does.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "lodestone/lodestone.h"

int main() {
  // A hilly square of 100 x 100 quads, two triangles each.
  const std::uint32_t side = 101;
  std::vector<float> positions;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < side * side; ++i) {
    const float x = static_cast<float>(i % side), y = static_cast<float>(i / side);
    positions.insert(positions.end(), {x, y, 3 * std::sin(x / 9) * std::cos(y / 7)});
    if (i % side == side - 1 || i / side == side - 1) continue;
    indices.insert(indices.end(), {i, i + 1, i + side, i + side, i + 1, i + side + 1});
  }
  lodestone::MeshArrays arrays;
  arrays.vertices = positions.size() / 3;
  arrays.positions = {positions.data()};
  arrays.indices = indices;
  auto mesh = lodestone::from_arrays(arrays);
  if (!mesh) return std::fprintf(stderr, "%s\n", mesh.error().line().c_str()), 1;

  // Called from the thread that works; another one may call task.cancel() at any time.
  const auto show = [](double done, const std::string& label) {
    std::fprintf(stderr, "\r%3.0f %% %s", 100 * done, label.c_str());
  };
  const lodestone::Task task = lodestone::Task::root(show, 2);
  auto result = lodestone::chain::build_ladder(lodestone::make_model(std::move(*mesh)), {}, task.part(1));
  if (!result) return std::fprintf(stderr, "%s\n", result.error().line().c_str()), 1;

  for (std::size_t i = 0; i < result->ladder.levels.size(); ++i) {
    const lodestone::MeshBuffers level = lodestone::to_arrays(result->ladder.model(i).meshes.front());
    std::printf("%6zu vertices, %6zu triangles, at most %g from the original\n", level.positions.size() / 3,
                level.indices.size() / 3, result->ladder.levels[i].error.error);
  }
  return 0;
}
