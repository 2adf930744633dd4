#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "lodestone/core/topology.h"
#include "lodestone/voxel/isosurface.h"
#include "lodestone/voxel/trilinear_cubes_detail.h"

namespace lodestone::voxel {
namespace {

using detail::CornerValues;

double trilinear(const CornerValues& v, double x, double y, double z) {
  double sum = 0;
  for (unsigned k = 0; k < 8; ++k) {
    sum += v[k] * ((k & 1) ? x : 1 - x) * ((k & 2) ? y : 1 - y) * ((k & 4) ? z : 1 - z);
  }
  return sum;
}

// Pieces of the inside and of the outside of a cube, by flooding many small ones.
struct Counted {
  int inside = 0, outside = 0;
};
Counted flooded(const CornerValues& v) {
  constexpr int n = 33;
  std::vector<int> label(n * n * n, 0);
  const auto at = [](int x, int y, int z) { return (z * n + y) * n + x; };
  std::vector<bool> in(n * n * n);
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        in[static_cast<std::size_t>(at(x, y, z))] = trilinear(v, x / 32.0, y / 32.0, z / 32.0) > 0;
      }
    }
  }
  Counted counted;
  std::vector<std::array<int, 3>> open;
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        if (label[static_cast<std::size_t>(at(x, y, z))] != 0) continue;
        const bool inside = in[static_cast<std::size_t>(at(x, y, z))];
        ++(inside ? counted.inside : counted.outside);
        open.push_back({x, y, z});
        label[static_cast<std::size_t>(at(x, y, z))] = 1;
        while (!open.empty()) {
          const auto p = open.back();
          open.pop_back();
          for (int k = 0; k < 6; ++k) {
            std::array<int, 3> q = p;
            q[static_cast<std::size_t>(k / 2)] += k % 2 ? 1 : -1;
            if (std::min({q[0], q[1], q[2]}) < 0 || std::max({q[0], q[1], q[2]}) >= n) continue;
            const auto i = static_cast<std::size_t>(at(q[0], q[1], q[2]));
            if (label[i] != 0 || in[i] != inside) continue;
            label[i] = 1;
            open.push_back(q);
          }
        }
      }
    }
  }
  return counted;
}

// A tube joins what two rings part: then all of the inside, and all of the outside, is one piece each.
TEST(TrilinearCube, has_the_tunnels_of_the_interpolant) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> value(-1, 1);
  int judged = 0, right = 0, tunnels = 0;
  for (int turn = 0; turn < 1500; ++turn) {
    CornerValues v;
    for (double& one : v) one = value(random);
    unsigned corners = 0;
    for (unsigned k = 0; k < 8; ++k) corners |= v[k] > 0 ? 1U << k : 0U;
    if (!detail::is_ambiguous(corners)) continue;
    const detail::TrilinearCube cube = detail::trilinear_cube(v);
    if (cube.loops.size() != 2) continue;
    const Counted truth = flooded(v);
    const bool tunnel = truth.inside == 1 && truth.outside == 1;
    ++judged;
    tunnels += tunnel;
    right += tunnel == cube.tunnel;
  }
  EXPECT_GT(judged, 100);
  EXPECT_GT(tunnels, 1);
  EXPECT_GE(right, judged - judged / 33) << "but for necks thinner than the flood's cells";
}

ScalarVolume<float> noise(std::uint32_t n, unsigned seed) {
  ScalarVolume<float> out;
  out.grid.size = {n, n, n};
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(-1, 1);
  for (std::uint64_t i = 0; i < out.grid.count(); ++i) out.values.push_back(value(random));
  return out;
}

TEST(TrilinearSurface, of_noise_is_closed_and_manifold_at_edges) {
  for (unsigned seed = 1; seed < 8; ++seed) {
    const auto mesh = isosurface(noise(14, seed), {0, true});
    ASSERT_TRUE(mesh);
    const Topology t = topology_of(*mesh);
    EXPECT_TRUE(t.closed);
    EXPECT_EQ(t.nonmanifold_edges + t.inconsistent_edges + t.duplicate_faces, 0U) << seed;
    EXPECT_EQ(t.vertices, mesh->vertex_count());
  }
}

// 0.1 is no float: values that equal the float next to it lie on one side of it in all parts of the work.
TEST(TrilinearSurface, at_a_value_that_is_no_float) {
  ScalarVolume<float> volume = noise(12, 3);
  for (std::size_t i = 0; i < volume.values.size(); i += 3) volume.values[i] = 0.1F;
  const auto mesh = isosurface(volume, {0.1, true});
  ASSERT_TRUE(mesh);
  const Topology t = topology_of(*mesh);
  EXPECT_TRUE(t.closed);
  EXPECT_EQ(t.nonmanifold_edges + t.inconsistent_edges, 0U);
}

// Two corners joined by their face: one piece where the table makes two.
TEST(TrilinearSurface, joins_corners_as_faces_do) {
  ScalarVolume<float> volume;
  volume.grid.size = {4, 4, 3};
  volume.values.assign(48, -1);
  volume.values[volume.index(1, 1, 1)] = volume.values[volume.index(2, 2, 1)] = 10;
  EXPECT_EQ(topology_of(*isosurface(volume, {0, true})).components, 1U);
  EXPECT_EQ(topology_of(*isosurface(volume, {0, false})).components, 2U);
}

}  // namespace
}  // namespace lodestone::voxel
