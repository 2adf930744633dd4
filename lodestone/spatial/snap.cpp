#include "lodestone/spatial/snap.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "lodestone/base/random.h"
#include "lodestone/core/mesh.h"

namespace lodestone::spatial {

namespace {

// Cells of the tolerance's size that hold the positions which kept their places. Cells are whole numbers in doubles, so
// that none overflows.
class Cells {
 public:
  Cells(const std::vector<Vec3f>& positions, double size)
      : positions_(positions), size_(size), next_(positions.size(), kNone) {
    first_.assign(std::bit_ceil(2 * positions.size() + 1), kNone);
  }

  void add(std::uint32_t v) {
    std::uint32_t& slot = slot_of(cell_of(to_double(positions_[v])));
    next_[v] = slot;
    slot = v;
  }

  std::uint32_t nearest(Vec3d p, double tolerance) const {
    std::uint32_t best = kNone;
    double best_sq = tolerance * tolerance;
    const Vec3d c = cell_of(p);
    for (int i = 0; i < 27; ++i) {
      const Vec3d cell{c.x + i % 3 - 1, c.y + i / 3 % 3 - 1, c.z + i / 9 - 1};
      for (std::uint32_t v = const_slot_of(cell); v != kNone; v = next_[v]) {
        const double d = length_sq(to_double(positions_[v]) - p);
        if (d < best_sq || (d == best_sq && v < best)) {
          best = v;
          best_sq = d;
        }
      }
    }
    return best;
  }

 private:
  Vec3d cell_of(Vec3d p) const { return {std::floor(p.x / size_), std::floor(p.y / size_), std::floor(p.z / size_)}; }
  // Cells that share a slot share its list: distances tell them apart.
  std::size_t index_of(Vec3d cell) const {
    std::uint64_t h = 0;
    for (const double x : {cell.x, cell.y, cell.z}) h = mix_bits(h ^ std::bit_cast<std::uint64_t>(x + 0.0));
    return h & (first_.size() - 1);
  }
  std::uint32_t& slot_of(Vec3d cell) { return first_[index_of(cell)]; }
  std::uint32_t const_slot_of(Vec3d cell) const { return first_[index_of(cell)]; }

  const std::vector<Vec3f>& positions_;
  double size_;
  std::vector<std::uint32_t> first_, next_;
};

}  // namespace

Result<std::size_t> snap_positions(std::vector<Vec3f>& positions, double tolerance,
                                   const std::vector<std::uint8_t>& fixed, Task task) {
  if (!(tolerance > 0) || !std::isfinite(tolerance)) {
    return fail(ErrorCode::bad_argument, "the welding tolerance is not a length above 0", "welding");
  }
  if (!fixed.empty() && fixed.size() != positions.size()) {
    return fail(ErrorCode::bad_argument, "the list of fixed positions has another length than the positions", "welding",
                "give one entry a position");
  }
  if (!std::all_of(positions.begin(), positions.end(), [](Vec3f p) { return is_finite(p); })) {
    return fail(ErrorCode::bad_argument, "a position is not finite", "welding", "leave it out");
  }
  Cells cells(positions, tolerance);
  std::size_t moved = 0;
  for (std::uint32_t v = 0; v < fixed.size(); ++v) {
    if (fixed[v] != 0) cells.add(v);
  }
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    if (!fixed.empty() && fixed[v] != 0) continue;
    if (v % 65536 == 0 && task.cancelled()) return cancelled_error("welding");
    const std::uint32_t near = cells.nearest(to_double(positions[v]), tolerance);
    if (near == kNone) {
      cells.add(v);
    } else if (positions[near] != positions[v]) {
      positions[v] = positions[near];
      ++moved;
    }
  }
  return moved;
}

}  // namespace lodestone::spatial
