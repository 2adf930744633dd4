// A tree of boxes over the triangles of a surface, for closest points and for boxes that overlap.
//
// The constructor needs no sorting: the surface's triangles lie along a Hilbert curve [skilling-2004], so the tree is
// that order cut into fours, level by level (level_sizes(), fill_level()). There are no pointers, and the boxes of a
// node's four children lie side by side, so that they are compared at once. Long thin triangles, whose boxes are mostly
// empty, get several boxes each ([ernst-greiner-2007], thin_pieces_detail.h).
//
// search() goes down from the root, nearest child first, with a stack of what is left. A child is left out when its box
// is farther than the best so far. closest(), closest_facing() and all_within() differ in which triangles they take and
// in how far they look. triangles_in() lists the triangles whose boxes reach into a box.
//
// Boxes are floats, rounded outward by kMargin so that rounding never hides a triangle; triangles are tested in double.
// Distances are therefore exact in double precision, whatever the hint. Built in O(n), or O(n log n) with thin pieces;
// the same for any number of threads. A query near the surface visits O(log n) nodes as a rule.
#include "lodestone/spatial/bvh.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "lodestone/base/parallel.h"
#include "lodestone/math/float4.h"
#include "lodestone/math/triangle.h"
#include "lodestone/spatial/thin_pieces_detail.h"

namespace lodestone::spatial {

namespace {

constexpr std::size_t kChunk = 4096;

// A bit for each of four comparisons.
unsigned bits_of(Int4 holds) {
#ifdef __SSE__
  return static_cast<unsigned>(__builtin_ia32_movmskps(reinterpret_cast<Float4>(holds)));
#else
  return (holds[0] != 0 ? 1U : 0U) | (holds[1] != 0 ? 2U : 0U) | (holds[2] != 0 ? 4U : 0U) | (holds[3] != 0 ? 8U : 0U);
#endif
}

Float4 at_least_zero(Float4 a) {
  const Float4 zero{};
  return a > zero ? a : zero;
}

Float4 larger(Float4 a, Float4 b) { return a > b ? a : b; }

// A child to visit: level (0 = triangle), index within the level, squared distance to its box.
struct Visit {
  float distance_sq;
  std::uint32_t level, index;
};

// Rounding to float and subtracting in float can move a side of a box by a few units in the last place of its largest
// coordinate, which is 1 here.
constexpr Vec3f kMargin{0x1p-21F, 0x1p-21F, 0x1p-21F};

// The box of a child that does not exist: far away, so that no query goes there. Infinities would make NaN.
constexpr Vec3f kNowhere{1e19F, 1e19F, 1e19F};

// Nodes of each level, from that above the leaves to the root.
std::vector<std::size_t> level_sizes(std::size_t leaves) {
  std::vector<std::size_t> sizes;
  std::size_t count = leaves;
  do {
    count = (count + 3) / 4;
    sizes.push_back(count);
  } while (count > 1);
  return sizes;
}

}  // namespace

Bvh::Bvh(const Surface& surface, const Task& task) : surface_(surface), center_(surface.bounds.center()) {
  const Vec3d half = surface.bounds.size() * 0.5;
  const double extent = std::max({half.x, half.y, half.z});
  scale_ = extent > 0 ? 1 / extent : 1;
  const std::vector<detail::Piece> pieces = detail::thin_pieces(surface, task);
  leaf_triangle_.reserve(pieces.size());
  for (const detail::Piece& piece : pieces) leaf_triangle_.push_back(piece.triangle);
  const std::size_t leaves = pieces.empty() ? surface.triangles.size() : pieces.size();
  const std::vector<std::size_t> sizes = level_sizes(leaves);
  level_first_.push_back(0);
  for (const std::size_t size : sizes) level_first_.push_back(level_first_.back() + static_cast<std::uint32_t>(size));
  nodes_.resize(level_first_.back());
  fill_level(0, leaves, task, [&](std::size_t leaf) {
    Box3f box;
    const auto add = [&](Vec3d c) { box.add(to_float((c - center_) * scale_)); };
    if (pieces.empty()) {
      for (const Vec3d c : surface.corners(leaf)) add(c);
    } else {
      add(pieces[leaf].box.min);
      add(pieces[leaf].box.max);
    }
    box.min -= kMargin;
    box.max += kMargin;
    return box;
  });
  for (std::size_t level = 1; level < sizes.size(); ++level) {
    fill_level(level, sizes[level - 1], task, [&](std::size_t child) {
      const Node& c = nodes_[level_first_[level - 1] + child];
      Box3f box;
      for (std::size_t s = 0; s < 4; ++s) {
        if (c.min[0][s] == kNowhere.x) continue;
        box.add(Vec3f{c.min[0][s], c.min[1][s], c.min[2][s]});
        box.add(Vec3f{c.max[0][s], c.max[1][s], c.max[2][s]});
      }
      return box;
    });
  }
}

template <class BoxOf>
void Bvh::fill_level(std::size_t level, std::size_t children, const Task& task, BoxOf box_of) {
  const std::size_t first = level_first_[level], size = level_first_[level + 1] - first;
  parallel_for(size, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t n = begin; n < end; ++n) {
      for (std::size_t slot = 0; slot < 4; ++slot) {
        const std::size_t child = n * 4 + slot;
        const Box3f box = child < children ? box_of(child) : Box3f{kNowhere, kNowhere};
        for (std::size_t k = 0; k < 3; ++k) {
          nodes_[first + n].min[k][slot] = box.min[k];
          nodes_[first + n].max[k][slot] = box.max[k];
        }
      }
    }
  });
}

Nearest Bvh::test(Vec3d p, std::uint32_t triangle) const {
  const auto [a, b, c] = surface_.corners(triangle);
  const ClosestPoint found = closest_point(p, a, b, c);
  return {triangle, found.point, found.distance_sq};
}

template <class Take>
void Bvh::search(Vec3d p, const double& limit_sq, Take&& take) const {
  const Vec3d local = (p - center_) * scale_;
  if (!(length_sq(local) < 1e24))
    return take(triangle_of(0));  // so far away that double can't tell one triangle from another
  const Vec3f q = to_float(local);
  const Float4 x{q.x, q.x, q.x, q.x}, y{q.y, q.y, q.y, q.y}, z{q.z, q.z, q.z, q.z};
  // Squared float distances are off by a few 1e-7 of themselves; q's own rounding is in the margin while it is near,
  // and relative to the distance when it is far.
  const double to_local = scale_ * scale_ * 1.000002;
  const auto limit = [&] { return static_cast<float>(std::min(limit_sq * to_local, 3e37)); };
  float worst = limit();
  Visit stack[96];
  std::size_t top = 0;
  stack[top++] = {0, static_cast<std::uint32_t>(level_first_.size() - 1), 0};
  while (top > 0) {
    const Visit visit = stack[--top];
    if (visit.distance_sq > worst) continue;
    if (visit.level == 0) {
      take(triangle_of(visit.index));
      worst = limit();
      continue;
    }
    const Node& node = nodes_[level_first_[visit.level - 1] + visit.index];
    const Float4 dx = at_least_zero(larger(load(node.min[0]) - x, x - load(node.max[0])));
    const Float4 dy = at_least_zero(larger(load(node.min[1]) - y, y - load(node.max[1])));
    const Float4 dz = at_least_zero(larger(load(node.min[2]) - z, z - load(node.max[2])));
    const Float4 d = dx * dx + dy * dy + dz * dz;
    const std::size_t first = top;
    for (std::uint32_t slot = 0; slot < 4; ++slot) {
      if (d[slot] > worst || d[slot] > 1e36F) continue;
      // Insertion keeps the nearest on top.
      std::size_t place = top++;
      while (place > first && stack[place - 1].distance_sq < d[slot]) {
        stack[place] = stack[place - 1];
        --place;
      }
      stack[place] = {d[slot], visit.level - 1, visit.index * 4 + slot};
    }
  }
}

Nearest Bvh::closest(Vec3d p, std::uint32_t hint) const {
  Nearest best;
  if (hint != kNone) best = test(p, hint);
  search(p, best.distance_sq, [&](std::uint32_t triangle) {
    const Nearest found = test(p, triangle);
    if (found.distance_sq < best.distance_sq ||
        (found.distance_sq == best.distance_sq && found.triangle < best.triangle)) {
      best = found;
    }
  });
  return best;
}

Nearest Bvh::closest_facing(Vec3d p, Vec3d normal, double within) const {
  Nearest best;
  best.distance_sq = within * within;
  search(p, best.distance_sq, [&](std::uint32_t triangle) {
    const auto [a, b, c] = surface_.corners(triangle);
    if (!(dot(scaled_normal(a, b, c), normal) > 0)) return;
    const Nearest found = test(p, triangle);
    if (found.distance_sq < best.distance_sq ||
        (found.distance_sq == best.distance_sq && found.triangle < best.triangle)) {
      best = found;
    }
  });
  return best;
}

void Bvh::all_within(Vec3d p, double within, std::vector<Nearest>& found) const {
  const double limit_sq = within * within;
  const auto first = static_cast<std::ptrdiff_t>(found.size());
  search(p, limit_sq, [&](std::uint32_t triangle) {
    const Nearest one = test(p, triangle);
    if (one.distance_sq <= limit_sq) found.push_back(one);
  });
  if (leaf_triangle_.empty()) return;
  std::sort(found.begin() + first, found.end(),
            [](const Nearest& a, const Nearest& b) { return a.triangle < b.triangle; });
  found.erase(std::unique(found.begin() + first, found.end(),
                          [](const Nearest& a, const Nearest& b) { return a.triangle == b.triangle; }),
              found.end());
}

bool Bvh::triangles_in(const Box3d& box, std::size_t most, std::vector<std::uint32_t>& found) const {
  found.clear();
  constexpr double kFar = 4;  // the tree's own boxes lie in [-1, 1]
  Float4 low[3], high[3];
  for (std::size_t k = 0; k < 3; ++k) {
    // Rounding is in the margin of the tree's boxes.
    const auto l = static_cast<float>(std::clamp((box.min[k] - center_[k]) * scale_, -kFar, kFar));
    const auto h = static_cast<float>(std::clamp((box.max[k] - center_[k]) * scale_, -kFar, kFar));
    low[k] = Float4{l, l, l, l};
    high[k] = Float4{h, h, h, h};
  }
  struct StackEntry {
    std::uint32_t level, index;
  };
  StackEntry stack[96];
  std::size_t top = 0;
  stack[top++] = {static_cast<std::uint32_t>(level_first_.size() - 1), 0};
  while (top > 0) {
    const StackEntry place = stack[--top];
    const Node& node = nodes_[level_first_[place.level - 1] + place.index];
    auto inside = load(node.min[0]) <= high[0] && load(node.max[0]) >= low[0];
    for (std::size_t k = 1; k < 3; ++k) inside = inside && load(node.min[k]) <= high[k] && load(node.max[k]) >= low[k];
    unsigned left = bits_of(inside);
    while (left != 0) {
      const auto slot = static_cast<std::uint32_t>(31 - std::countl_zero(left));
      left ^= 1U << slot;
      const std::uint32_t child = place.index * 4 + slot;
      if (place.level > 1) {
        stack[top++] = {place.level - 1, child};
      } else {
        if (found.size() == most) return false;
        found.push_back(triangle_of(child));
      }
    }
  }
  if (leaf_triangle_.empty()) return true;
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return true;
}

}  // namespace lodestone::spatial
