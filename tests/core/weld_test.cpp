#include "lodestone/core/weld.h"

#include <gtest/gtest.h>

#include <limits>

#include "lodestone/base/random.h"
#include "lodestone/core/validate.h"
#include "support/shapes.h"

namespace lodestone {
namespace {

// Every corner a vertex of its own, as an STL has it.
Mesh exploded(const Mesh& mesh) {
  Mesh out;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = static_cast<std::uint32_t>(out.positions.size());
      out.positions.push_back(mesh.positions[mesh.vertices_of(t)[k]]);
    }
    out.triangles.push_back(corners);
  }
  return out;
}

TEST(Weld, a_soup_becomes_the_mesh_it_was) {
  const Mesh torus = test::torus(16);
  const auto welded = weld_exact(exploded(torus));
  ASSERT_TRUE(welded);
  EXPECT_EQ(welded->vertex_count(), torus.vertex_count());
  EXPECT_TRUE(welded->wedge_vertex.empty());
  for (std::size_t t = 0; t < torus.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(welded->positions[welded->triangles[t][k]], torus.positions[torus.triangles[t][k]]);
    }
  }
}

TEST(Weld, equal_positions_with_other_attributes_are_wedges) {
  Mesh mesh = test::cube_with_seams();
  Mesh file = mesh;  // as a file has it: a vertex a wedge
  file.positions.clear();
  for (const std::uint32_t v : mesh.wedge_vertex) file.positions.push_back(mesh.positions[v]);
  file.wedge_vertex.clear();
  const auto welded = weld_exact(file);
  ASSERT_TRUE(welded);
  EXPECT_EQ(welded->vertex_count(), 8U);
  EXPECT_EQ(welded->wedge_count(), 24U);
  EXPECT_TRUE(validate(*welded));
}

TEST(Weld, minus_zero_is_zero_and_unused_vertices_go) {
  Mesh mesh = test::make_mesh({{9, 9, 9}, {0.0F, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0F, 0, 0}, {0, 0, 1}},
                              {{1, 2, 3}, {4, 3, 5}});
  const auto welded = weld_exact(mesh);
  ASSERT_TRUE(welded);
  EXPECT_EQ(welded->vertex_count(), 4U);
  EXPECT_EQ(welded->triangles[1][0], welded->triangles[0][0]);
}

// As many as this took a minute where each was compared with all.
TEST(Weld, vertices_that_are_no_numbers_go_quickly) {
  Mesh mesh = test::torus(8);
  const std::size_t vertices = mesh.vertex_count();
  mesh.positions.resize(vertices + 400'000, Vec3f{std::numeric_limits<float>::quiet_NaN(), 0, 0});
  const auto welded = weld_exact(std::move(mesh));
  ASSERT_TRUE(welded);
  EXPECT_EQ(welded->vertex_count(), vertices);
}

TEST(Weld, large_meshes_give_the_same_with_any_threads) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < 300'000; ++i) {
    const auto c = [&](std::uint64_t s) { return static_cast<float>(random_bits(s, i) % 40); };
    mesh.positions.push_back({c(1), c(2), c(3)});
    if (i % 3 == 2) mesh.triangles.push_back({i - 2, i - 1, i});
  }
  const auto one = weld_exact(mesh, Task::root({}, 1)), seven = weld_exact(mesh, Task::root({}, 7));
  EXPECT_EQ(one->positions, seven->positions);
  EXPECT_EQ(one->triangles, seven->triangles);
  EXPECT_LE(one->vertex_count(), 64'000U);
}

TEST(Weld, classes_ignore_the_streams_left_out) {
  const Mesh mesh = test::cube_with_seams();
  const auto by_all = wedge_classes(mesh, {true, true}), by_none = wedge_classes(mesh, {false, false});
  for (std::uint32_t w = 0; w < mesh.wedge_count(); ++w) {
    EXPECT_EQ(by_all[w], w);
    EXPECT_EQ(mesh.wedge_vertex[by_none[w]], mesh.wedge_vertex[w]);
  }
  for (std::uint32_t w = 1; w < mesh.wedge_count(); ++w) {
    EXPECT_EQ(by_none[w] == 0, mesh.wedge_vertex[w] == mesh.wedge_vertex[0]);
  }
}

}  // namespace
}  // namespace lodestone
