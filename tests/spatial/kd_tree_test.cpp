#include "lodestone/spatial/kd_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lodestone/base/random.h"

namespace lodestone::spatial {
namespace {

float unit(std::uint64_t seed, std::uint64_t i) { return static_cast<float>(random_unit(seed, i)); }

std::vector<Vec3f> random_points(std::size_t n, std::uint64_t seed = 1) {
  std::vector<Vec3f> out(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = {unit(seed, 3 * i), unit(seed, 3 * i + 1), unit(seed, 3 * i + 2)};
  return out;
}

std::vector<Vec3f> lattice(int nx, int ny, int nz) {
  std::vector<Vec3f> out;
  out.reserve(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz));
  for (int z = 0; z < nz; ++z) {
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        out.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
      }
    }
  }
  return out;
}

struct Case {
  const char* name;
  std::vector<Vec3f> points;
};

std::vector<Case> cases() {
  std::vector<Case> out{{"random", random_points(1000)}, {"few", random_points(3)}, {"one", random_points(1)}};
  out.push_back({"all the same", std::vector<Vec3f>(500, Vec3f{1, 2, 3})});
  out.push_back({"grid with many ties", lattice(10, 10, 10)});
  std::vector<Vec3f> twice = random_points(300);
  twice.insert(twice.end(), twice.begin(), twice.begin() + 300);
  out.push_back({"twice", twice});
  std::vector<Vec3f> apart = random_points(400, 4);
  for (std::size_t i = 0; i < 400; ++i) apart[i] = i % 2 == 0 ? apart[i] * 1e-3F : apart[i] * 1e-3F + Vec3f{1e6, 0, 0};
  out.push_back({"clusters far apart", apart});
  std::vector<Vec3f> huge = random_points(200, 5), tiny = huge;
  for (Vec3f& p : huge) p *= 1e37F;
  for (Vec3f& p : tiny) p *= 1e-30F;
  out.push_back({"huge", huge});
  out.push_back({"tiny", tiny});
  std::vector<Vec3f> line(300);
  for (std::size_t i = 0; i < line.size(); ++i) line[i] = {static_cast<float>(i * i), 0, 0};
  out.push_back({"line", line});
  return out;
}

std::vector<double> brute(const std::vector<Vec3f>& points, Vec3d at, std::size_t without) {
  std::vector<double> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i != without) out.push_back(std::sqrt(length_sq(to_double(points[i]) - at)));
  }
  std::sort(out.begin(), out.end());
  return out;
}

// Single precision relative to the coordinates' size.
double slack(const std::vector<Vec3f>& points) {
  double largest = 0;
  for (const Vec3f& p : points) largest = std::max(largest, length(to_double(p)));
  return largest * 1e-6;
}

TEST(KdTree, neighbors_are_those_of_brute_force) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const KdTree tree(c.points);
    const std::size_t k = 9;
    std::vector<std::vector<Neighbor>> got(c.points.size());
    tree.each_neighborhood(k, {}, [&](std::uint32_t point, std::span<const Neighbor> near) {
      got[point].assign(near.begin(), near.end());
    });
    for (std::size_t i = 0; i < c.points.size(); ++i) {
      const std::vector<double> expected = brute(c.points, to_double(c.points[i]), i);
      ASSERT_EQ(got[i].size(), std::min(k, expected.size()));
      std::vector<std::uint32_t> names;
      for (std::size_t j = 0; j < got[i].size(); ++j) {
        ASSERT_NEAR(std::sqrt(got[i][j].distance_sq), expected[j], slack(c.points));
        ASSERT_NEAR(length(to_double(c.points[got[i][j].point] - c.points[i])), expected[j], slack(c.points));
        names.push_back(got[i][j].point);
      }
      std::sort(names.begin(), names.end());
      ASSERT_TRUE(std::adjacent_find(names.begin(), names.end()) == names.end()) << "no point twice";
      ASSERT_FALSE(std::binary_search(names.begin(), names.end(), i)) << "not itself";
    }
  }
}

TEST(KdTree, nearest_from_anywhere) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const KdTree tree(c.points);
    Box3d box;
    for (const Vec3f& p : c.points) box.add(to_double(p));
    for (std::uint64_t q = 0; q < 50; ++q) {
      const Vec3d share{random_unit(9, 3 * q), random_unit(9, 3 * q + 1), random_unit(9, 3 * q + 2)};
      const Vec3d size = box.size();
      const Vec3d at =
          box.center() + Vec3d{(share.x * 2 - 1) * size.x, (share.y * 2 - 1) * size.y, (share.z * 2 - 1) * size.z};
      const std::vector<double> expected = brute(c.points, at, c.points.size());
      std::array<Neighbor, 4> near;
      const std::size_t count = tree.nearest(at, near);
      ASSERT_EQ(count, std::min<std::size_t>(4, c.points.size()));
      for (std::size_t j = 0; j < count; ++j) {
        ASSERT_NEAR(std::sqrt(near[j].distance_sq), expected[j], slack(c.points) + 1e-6 * expected[j] + 1e-30);
      }
      const double limit = expected[0] * expected[0] * 0.99;
      ASSERT_EQ(tree.nearest(at, near, limit), 0U);
    }
  }
}

TEST(KdTree, empty_and_large_duplicates_end) {
  const KdTree none(std::span<const Vec3f>{});
  std::array<Neighbor, 1> near;
  EXPECT_EQ(none.nearest({0, 0, 0}, near), 0U);
  const KdTree same(std::vector<Vec3f>(300000, Vec3f{5, 5, 5}));
  std::size_t least = 100;
  same.each_neighborhood(12, Task::root({}, 1), [&](std::uint32_t, std::span<const Neighbor> found) {
    least = std::min(least, found.size());
  });
  EXPECT_EQ(least, 12U);
}

TEST(KdTree, same_neighbors_for_any_thread_count) {
  std::vector<std::vector<std::uint32_t>> first;
  for (const int threads : {1, 2, 7}) {
    const Task task = Task::root({}, threads);
    const std::vector<Vec3f> points = random_points(20000, 11);
    const KdTree tree(points, task);
    std::vector<std::vector<std::uint32_t>> got(points.size());
    tree.each_neighborhood(6, task, [&](std::uint32_t point, std::span<const Neighbor> near) {
      for (const Neighbor& n : near) got[point].push_back(n.point);
    });
    if (first.empty()) first = got;
    EXPECT_EQ(first, got);
  }
}

TEST(KdTree, spacing_of_a_grid) {
  const std::vector<Vec3f> points = lattice(50, 50, 1);
  EXPECT_NEAR(point_spacing(KdTree(points)).median, std::sqrt(2.0), 1e-5);
  EXPECT_EQ(point_spacing(KdTree(std::span<const Vec3f>{})).median, 0);
}

}  // namespace
}  // namespace lodestone::spatial
