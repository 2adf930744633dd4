#include <array>

#include "lodestone/base/parallel.h"
#include "lodestone/measure/split_detail.h"

namespace lodestone::measure::detail {

namespace {

using Middles = std::array<std::uint32_t, 3>;  // middles[k] lies between corners k and k + 1; kNone: not split

void split_one(const Triangle& t, const Middles& m, std::vector<Triangle>& out) {
  const auto count = 3 - std::count(m.begin(), m.end(), kNone);
  if (count == 0) {
    out.push_back(t);
    return;
  }
  if (count == 3) {
    out.insert(out.end(), {{t[0], m[0], m[2]}, {m[0], t[1], m[1]}, {m[2], m[1], t[2]}, {m[0], m[1], m[2]}});
    return;
  }
  // Turned so that the first side is split and, of two, the second as well.
  std::size_t k = 0;
  while (m[k] == kNone || (count == 2 && m[(k + 1) % 3] == kNone)) ++k;
  const std::uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
  const std::uint32_t ab = m[k], bc = m[(k + 1) % 3];
  if (count == 1) {
    out.insert(out.end(), {{a, ab, c}, {ab, b, c}});
  } else {
    out.insert(out.end(), {{ab, b, bc}, {a, ab, bc}, {a, bc, c}});
  }
}

}  // namespace

void sort_unique(std::vector<EdgeKey>& sides, const Task& task) {
  parallel_sort(sides, task, [](const EdgeKey& a, const EdgeKey& b) { return a < b; });
  sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
}

std::vector<Triangle> split_sides(std::span<const Triangle> triangles, std::span<const EdgeKey> sides,
                                  std::size_t first) {
  std::vector<Triangle> out;
  out.reserve(triangles.size() + 2 * sides.size());
  for (const Triangle& t : triangles) {
    Middles middles;
    for (std::size_t k = 0; k < 3; ++k) {
      const EdgeKey side = edge_of(t[k], t[(k + 1) % 3]);
      const auto found = std::lower_bound(sides.begin(), sides.end(), side);
      const bool is_split = found != sides.end() && *found == side;
      middles[k] =
          is_split ? static_cast<std::uint32_t>(first + static_cast<std::size_t>(found - sides.begin())) : kNone;
    }
    split_one(t, middles, out);
  }
  return out;
}

}  // namespace lodestone::measure::detail
