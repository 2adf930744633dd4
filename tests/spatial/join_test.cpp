#include "lodestone/spatial/join.h"

#include <gtest/gtest.h>

#include "lodestone/base/random.h"
#include "lodestone/core/parts.h"
#include "lodestone/core/topology.h"
#include "lodestone/core/weld.h"
#include "support/shapes.h"

namespace lodestone::spatial {
namespace {

void append(Mesh& mesh, const Mesh& more, Vec3f by) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3f& p : more.positions) mesh.positions.push_back(p + by);
  for (const Triangle& t : more.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

Mesh joined(Mesh mesh, double tolerance, std::size_t* moved = nullptr) {
  const auto r = join_parts(mesh, tolerance);
  EXPECT_TRUE(r);
  if (moved != nullptr) *moved = *r;
  return *weld_exact(std::move(mesh));
}

TEST(Join, sheets_side_by_side_become_one) {
  Mesh mesh = test::grid(6);
  append(mesh, test::grid(6), {1.001F, 0, 0.0005F});
  std::size_t moved = 0;
  const Mesh one = joined(mesh, 0.01, &moved);
  EXPECT_EQ(moved, 7U);
  const Topology t = topology_of(one);
  EXPECT_EQ(t.components, 1U);
  EXPECT_EQ(t.boundary_edges, 36U) << "the border of one sheet of 6 x 12";
  EXPECT_TRUE(t.manifold);
  EXPECT_EQ(t.inconsistent_edges, 0U);
  EXPECT_EQ(topology_of(joined(mesh, 0.0005)).components, 2U) << "farther apart than that";
}

TEST(Join, locked_vertices_stay_and_the_others_come) {
  Mesh mesh = test::grid(6);
  append(mesh, test::grid(6), {1.001F, 0, 0});
  std::vector<std::uint8_t> locked(mesh.vertex_count(), 0);
  for (std::size_t v = mesh.vertex_count() / 2; v < locked.size(); ++v) locked[v] = 1;
  Mesh after = mesh;
  ASSERT_TRUE(join_parts(after, 0.01, locked));
  for (std::size_t v = 0; v < locked.size(); ++v) {
    EXPECT_TRUE(locked[v] == 0 || after.positions[v] == mesh.positions[v]);
  }
  EXPECT_EQ(topology_of(*weld_exact(std::move(after))).components, 1U);
}

TEST(Join, vertices_of_one_part_are_never_joined) {
  Mesh strip = test::grid(6);  // bent so that its ends nearly meet
  for (Vec3f& p : strip.positions) p = {p.x < 0.5F ? p.x : 1.001F - p.x, p.y, p.x < 0.5F ? 0.0F : 0.001F};
  const Mesh before = strip;
  EXPECT_EQ(*join_parts(strip, 0.1), 0U);
  EXPECT_EQ(strip.positions, before.positions);
}

TEST(Join, sheets_that_turn_the_other_way_or_touch_in_a_point_stay_apart) {
  Mesh flipped = test::grid(2);
  Mesh other = test::grid(2);
  for (Triangle& t : other.triangles) std::swap(t[1], t[2]);
  append(flipped, other, {1.001F, 0, 0});
  EXPECT_EQ(topology_of(joined(flipped, 0.01)).inconsistent_edges, 0U);
  Mesh corner = test::grid(2);
  append(corner, test::grid(2), {1.001F, 1.001F, 0});
  std::size_t moved = 0;
  EXPECT_EQ(topology_of(joined(corner, 0.01, &moved)).nonmanifold_vertices, 0U);
  EXPECT_EQ(moved, 0U);
  Mesh cubes = test::cube();
  append(cubes, test::cube(), {1.001F, 0, 0});
  EXPECT_EQ(topology_of(joined(cubes, 0.01)).components, 2U) << "closed parts have no border";
}

TEST(Join, a_sheet_over_another_does_not_double_faces) {
  for (const int cells : {1, 2, 5}) {
    Mesh mesh = test::grid(cells);
    Mesh back = test::grid(cells);
    for (Triangle& t : back.triangles) std::swap(t[1], t[2]);
    append(mesh, back, {0, 0, 0.001F});
    const Topology t = topology_of(joined(mesh, 0.01));
    EXPECT_EQ(t.duplicate_faces, 0U) << cells;
    EXPECT_EQ(t.nonmanifold_edges, 0U) << cells;
    EXPECT_EQ(t.inconsistent_edges, 0U) << cells;
  }
}

// Random shards of grids in a heap: whatever the tolerance, nothing gets worse.
TEST(Join, no_edge_gets_worse_and_no_triangle_turns) {
  Mesh heap;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const auto at = [&](std::uint64_t k) { return static_cast<float>(random_unit(17, 8 * i + k)); };
    Mesh shard = test::grid(3, at(3));
    for (Vec3f& p : shard.positions) p = Vec3f{p.x, p.y * (0.5F + at(4)), p.z + at(5) * p.x} * 0.3F;
    append(heap, shard, {at(0), at(1), at(2) * 0.3F});
  }
  const Topology before = topology_of(heap);
  for (const double tolerance : {0.003, 0.03, 0.1, 0.5}) {
    Mesh moved = heap;
    const auto count = join_parts(moved, tolerance);
    ASSERT_TRUE(count);
    for (std::uint32_t v = 0; v < heap.vertex_count(); ++v) {
      EXPECT_LE(length(moved.position(v) - heap.position(v)), tolerance * 1.000001);
    }
    const Mesh after = *weld_exact(moved);
    const Topology t = topology_of(after);
    EXPECT_LE(t.nonmanifold_edges, before.nonmanifold_edges) << tolerance;
    EXPECT_LE(t.duplicate_faces, before.duplicate_faces) << tolerance;
    EXPECT_LE(t.degenerate_triangles, before.degenerate_triangles) << tolerance;
    EXPECT_LE(t.inconsistent_edges, before.inconsistent_edges) << tolerance;
    EXPECT_EQ(after.vertex_count() + *count, heap.vertex_count());
    EXPECT_TRUE(*count == 0 || t.boundary_edges < before.boundary_edges);
  }
}

TEST(Join, odd_meshes_and_arguments) {
  for (const test::Shape& shape : test::small_shapes()) {
    Mesh mesh = shape.make();
    EXPECT_TRUE(join_parts(mesh, 0.5)) << shape.name;
  }
  Mesh mesh = test::grid(2);
  EXPECT_EQ(join_parts(mesh, 0).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(join_parts(mesh, 1, {1}).error().code, ErrorCode::bad_argument);
  const Task task = Task::root({});
  task.cancel();
  EXPECT_EQ(join_parts(mesh, 1, {}, task).error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace lodestone::spatial
