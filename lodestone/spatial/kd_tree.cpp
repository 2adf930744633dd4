// Nearest points: a balanced tree whose shape depends on the number of points alone.
//
// 1. The constructor scales points by a power of two (unit_of()), so that squares fit floats. It halves them level by
//    level along the longest side of each node's box (Builder::split(), the nodes of a level in parallel). Leaves hold
//    at most sixteen points. All nodes of a level have the same number of points, or one more, so nodes need no
//    pointers, and no arrangement of points makes a leaf large or the tree deep.
// 2. search() goes down from the root with a sorted list of the best so far; scan_leaf() tests a leaf's points. A node
//    is left out when its box is farther than the last of the list. box_distance_sq() adds in the same order as the
//    distance of a point, so rounding never makes a box look farther than a point in it.
// 3. around() searches from a point of the tree, with a bound from the query before; nearest() from any place.
//    point_spacing() asks nearest() for a sample of the points.
//
// Points with equal coordinates are told apart by number: the same answers for any number of threads. Built in
// O(n log n), a query about O(k + log n) for k points.
#include "lodestone/spatial/kd_tree.h"

#include <algorithm>
#include <cmath>

#include "lodestone/base/check.h"

namespace lodestone::spatial {

namespace {

struct Item {
  std::array<float, 3> at;
  std::uint32_t point;
};

// The power of two next above the largest coordinate.
double unit_of(const Box3f& box) {
  double largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    largest = std::max({largest, std::abs(static_cast<double>(box.min[k])), std::abs(static_cast<double>(box.max[k]))});
  }
  if (!(largest > 0)) return 1;
  int exponent = 0;
  std::frexp(largest, &exponent);  // exact
  return std::ldexp(1.0, exponent);
}

}  // namespace

struct KdTree::Builder {
  KdTree& tree;
  std::vector<Item>& items;

  // The box of a node, and its points halved along the longest side.
  void split(std::size_t node, unsigned level) {
    const std::size_t begin = tree.first_of(node, level), end = tree.first_of(node + 1, level);
    Box3f box;
    for (std::size_t i = begin; i < end; ++i) box.add(Vec3f{items[i].at[0], items[i].at[1], items[i].at[2]});
    tree.boxes_[(std::size_t{1} << level) + node] = box;
    if (level == tree.levels_) return;
    const Vec3f size = box.size();
    const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = tree.first_of(2 * node + 1, level + 1);
    const auto at = [&](std::size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [axis](const Item& a, const Item& b) {
      return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.point < b.point;
    });
  }
};

KdTree::KdTree(std::span<const Vec3f> points, const Task& task) {
  LODESTONE_CHECK(points.size() < std::numeric_limits<std::uint32_t>::max(), "points are named by 32 bits");
  const std::size_t n = points.size();
  Box3f box;
  for (const Vec3f& p : points) box.add(p);
  LODESTONE_CHECK(n == 0 || (is_finite(box.min) && is_finite(box.max)), "points are finite");
  unit_ = n == 0 ? 1.0 : unit_of(box);
  std::vector<Item> items(n);
  parallel_for(n, 65536, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3d p = to_double(points[i]) / unit_;
      items[i] = {{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)},
                  static_cast<std::uint32_t>(i)};
    }
  });
  order_.resize(n);
  while (n > kLeaf << levels_) ++levels_;
  boxes_.resize(std::size_t{2} << levels_);
  Builder builder{*this, items};
  for (unsigned level = 0; level <= levels_; ++level) {
    const std::size_t nodes = std::size_t{1} << level;
    parallel_for(nodes, std::max<std::size_t>(1, nodes / 64), task,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                   for (std::size_t node = begin; node < end; ++node) builder.split(node, level);
                 });
  }
  for (auto& coordinates : at_) coordinates.assign(n + kLeaf, 0);
  for (std::size_t i = 0; i < n; ++i) {
    order_[i] = items[i].point;
    for (std::size_t k = 0; k < 3; ++k) at_[k][i] = items[i].at[k];
  }
}

// Computed in the same order of operations as the distance to a point, so that rounding never makes it larger than that
// to a point in the box.
float KdTree::box_distance_sq(std::size_t node, std::array<float, 3> at) const {
  const Box3f& box = boxes_[node];
  const float x = std::max({box.min.x - at[0], 0.0F, at[0] - box.max.x});
  const float y = std::max({box.min.y - at[1], 0.0F, at[1] - box.max.y});
  const float z = std::max({box.min.z - at[2], 0.0F, at[2] - box.max.z});
  return x * x + y * y + z * z;
}

std::size_t KdTree::scan_leaf(std::size_t leaf, std::array<float, 3> at, std::span<Found> found, std::size_t count,
                              float& worst) const {
  const std::size_t begin = first_of(leaf, levels_), end = first_of(leaf + 1, levels_);
  const float *xs = at_[0].data() + begin, *ys = at_[1].data() + begin, *zs = at_[2].data() + begin;
  float distance_sq[kLeaf];
  for (std::size_t i = 0; i < kLeaf; ++i) {
    const float x = xs[i] - at[0], y = ys[i] - at[1], z = zs[i] - at[2];
    distance_sq[i] = x * x + y * y + z * z;
  }
  for (std::size_t i = 0; i < end - begin; ++i) {
    const float d = distance_sq[i];
    if (!(d < worst)) continue;
    std::size_t place = count < found.size() ? count++ : count - 1;
    for (; place > 0 && found[place - 1].distance_sq > d; --place) found[place] = found[place - 1];
    found[place] = {d, static_cast<std::uint32_t>(begin + i)};
    if (count == found.size()) worst = found[count - 1].distance_sq;
  }
  return count;
}

std::size_t KdTree::search(std::array<float, 3> at, std::span<Found> found, float below_sq) const {
  if (order_.empty() || found.empty()) return 0;
  struct Waiting {
    std::size_t node;
    float distance_sq;
  };
  std::array<Waiting, 40> stack;
  std::size_t waiting = 0, count = 0;
  float worst = below_sq;
  stack[waiting++] = {1, box_distance_sq(1, at)};
  const std::size_t leaves = std::size_t{1} << levels_;
  while (waiting > 0) {
    const Waiting next = stack[--waiting];
    if (!(next.distance_sq < worst)) continue;
    std::size_t node = next.node;
    while (node < leaves) {
      const float low = box_distance_sq(2 * node, at), high = box_distance_sq(2 * node + 1, at);
      const bool low_first = low <= high;
      const float far = low_first ? high : low;
      if (far < worst) stack[waiting++] = {2 * node + (low_first ? 1U : 0U), far};
      node = 2 * node + (low_first ? 0U : 1U);
    }
    count = scan_leaf(node - leaves, at, found, count, worst);
  }
  return count;
}

std::size_t KdTree::around(std::size_t slot, std::span<Found> found, Hint& hint) const {
  const std::array<float, 3> at{at_[0][slot], at_[1][slot], at_[2][slot]};
  float below_sq = std::numeric_limits<float>::infinity();
  if (hint.there) {
    const float x = at_[0][hint.slot] - at[0], y = at_[1][hint.slot] - at[1], z = at_[2][hint.slot] - at[2];
    const float reach = std::sqrt(hint.reach_sq) + std::sqrt(x * x + y * y + z * z);
    below_sq = std::max(reach * reach * 1.0001F, std::numeric_limits<float>::min());
  }
  std::size_t count = search(at, found, below_sq);
  hint = {count == found.size(), slot, count > 0 ? found[count - 1].distance_sq : 0};
  // The point itself is left out; among many duplicates it may not have been found.
  std::size_t self = 0;
  while (self < count && found[self].slot != slot) ++self;
  if (self < count) {
    std::copy(found.begin() + static_cast<std::ptrdiff_t>(self) + 1, found.begin() + static_cast<std::ptrdiff_t>(count),
              found.begin() + static_cast<std::ptrdiff_t>(self));
    --count;
  }
  return std::min(count, found.size() - 1);
}

std::size_t KdTree::nearest(Vec3d at, std::span<Neighbor> into, double below_sq) const {
  constexpr std::size_t kMost = 64;
  std::array<Found, kMost> few;
  std::vector<Found> many(into.size() > kMost ? into.size() : 0);
  const std::span<Found> found = many.empty() ? std::span(few).first(into.size()) : std::span(many);
  std::array<float, 3> scaled{};
  for (std::size_t k = 0; k < 3; ++k) scaled[k] = static_cast<float>(std::clamp(at[k] / unit_, -1e18, 1e18));
  const double below = std::min(below_sq / unit_ / unit_, 1e38);
  const float limit = std::isinf(below_sq) ? std::numeric_limits<float>::infinity() : static_cast<float>(below);
  const std::size_t count = search(scaled, found, limit);
  for (std::size_t i = 0; i < count; ++i) into[i] = neighbor(found[i]);
  return count;
}

Spacing point_spacing(const KdTree& tree, const Task& task) {
  if (tree.size() < 2) return {};
  constexpr std::size_t kSamples = 50000;
  const std::size_t step = std::max<std::size_t>(1, tree.size() / kSamples);
  std::vector<float> sixth((tree.size() + step - 1) / step, 0);
  parallel_for(sixth.size(), 1024, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::array<Neighbor, 7> near;  // the point itself, too
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t count = tree.nearest(tree.position(i * step), near);
      sixth[i] = static_cast<float>(std::sqrt(near[count - 1].distance_sq));
    }
  });
  const auto at_share = [&](double share) {
    const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(sixth.size() - 1));
    std::nth_element(sixth.begin(), sixth.begin() + place, sixth.end());
    return static_cast<double>(sixth[static_cast<std::size_t>(place)]);
  };
  const double median = at_share(0.5);
  return {median, at_share(0.98)};
}

}  // namespace lodestone::spatial
