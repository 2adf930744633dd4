#include "lodestone/core/topology.h"

#include <gtest/gtest.h>

#include "lodestone/core/adjacency.h"
#include "lodestone/core/validate.h"
#include "support/shapes.h"

namespace lodestone {
namespace {

TEST(Topology, closed_shapes) {
  for (const test::Shape& shape : test::small_shapes()) {
    const Mesh mesh = shape.make();
    ASSERT_TRUE(validate(mesh)) << shape.name;
    const Topology t = topology_of(mesh);
    EXPECT_EQ(t.closed && t.manifold && t.duplicate_faces == 0, shape.closed_manifold) << shape.name;
  }
}

TEST(Topology, counts) {
  const Topology grid = topology_of(test::grid(3));
  EXPECT_EQ(grid.boundary_edges, 12U);
  EXPECT_EQ(grid.components, 1U);
  EXPECT_TRUE(grid.manifold);
  const Topology tie = topology_of(test::bow_tie());
  EXPECT_EQ(tie.nonmanifold_vertices, 1U);
  EXPECT_EQ(tie.components, 1U);
  const Topology book = topology_of(test::three_faces_on_an_edge());
  EXPECT_EQ(book.nonmanifold_edges, 1U);
  EXPECT_EQ(book.nonmanifold_vertices, 2U);
  EXPECT_GT(topology_of(test::moebius(20)).inconsistent_edges, 0U);
  EXPECT_EQ(topology_of(test::offset_plates(4)).components, 2U);
  EXPECT_EQ(topology_of(test::torus(8)).edges, 3U * 64);
  EXPECT_EQ(topology_of(test::cube_with_seams()).wedges, 24U);
}

TEST(Topology, doubled_faces_close_no_sheet) {
  const auto listed_again = [](Mesh mesh, bool turned) {
    const std::vector<Triangle> once = mesh.triangles;
    for (const Triangle& t : once) mesh.triangles.push_back(turned ? Triangle{t[0], t[2], t[1]} : t);
    return topology_of(mesh);
  };
  for (const bool turned : {false, true}) {
    const Topology sheet = listed_again(test::grid(3), turned);
    EXPECT_EQ(sheet.boundary_edges, 0U) << "as a checker counts them";
    EXPECT_FALSE(sheet.closed);
  }
  EXPECT_EQ(listed_again(test::grid(3), false).hidden_boundary_edges, 12U);
  for (const bool turned : {false, true}) EXPECT_TRUE(listed_again(test::torus(8), turned).closed);
  Mesh flap = test::torus(8);  // a face and its back on an edge of a closed surface
  flap.positions.push_back({9, 9, 9});
  const auto tip = static_cast<std::uint32_t>(flap.positions.size() - 1);
  const Triangle t = flap.triangles[0];
  flap.triangles.push_back({t[0], t[1], tip});
  flap.triangles.push_back({t[0], tip, t[1]});
  EXPECT_TRUE(topology_of(flap).closed);
}

TEST(Topology, a_doubled_sheet_is_open_beside_what_is_closed) {
  Mesh both = test::torus(8);
  const Mesh sheet = test::grid(3);
  const auto first = static_cast<std::uint32_t>(both.positions.size());
  for (const Vec3f& p : sheet.positions) both.positions.push_back({p.x + 9, p.y, p.z});
  for (const Triangle& t : sheet.triangles) {
    both.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    both.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  }
  const Topology t = topology_of(both);
  EXPECT_FALSE(t.closed);
  EXPECT_EQ(t.boundary_edges, 0U);
  EXPECT_EQ(t.hidden_boundary_edges, 12U);
}

TEST(Topology, a_fan_of_many_triangles_takes_bounded_time) {
  Mesh mesh;
  mesh.positions.push_back({});
  for (std::uint32_t i = 0; i < 200'000; ++i) {
    mesh.positions.push_back({1, float(i), 0});
    if (i > 0) mesh.triangles.push_back({0, i, i + 1});
  }
  EXPECT_TRUE(topology_of(mesh).manifold);
}

TEST(Adjacency, edges_name_their_triangles) {
  const Mesh mesh = test::tetrahedron();
  const EdgeTriangles edges = edge_triangles(mesh);
  ASSERT_EQ(edges.edges.size(), 6U);
  for (const Edge& edge : edges.edges) {
    EXPECT_LT(edge.a, edge.b);
    EXPECT_EQ(edge.count, 2U);
  }
  for (std::uint32_t v = 0; v < 4; ++v) EXPECT_EQ(vertex_triangles(mesh).of(v).size(), 3U);
}

TEST(Mesh, volume_and_area) {
  EXPECT_NEAR(volume_of(test::cube()), 1, 1e-12);
  EXPECT_NEAR(area_of(test::cube()), 6, 1e-12);
  EXPECT_NEAR(bounds_of(test::cube()).diagonal(), std::sqrt(3.0), 1e-12);
  Mesh far = test::cube();
  far.offset = {1e7, 0, 0};
  EXPECT_NEAR(volume_of(far), 1, 1e-12);
  EXPECT_DOUBLE_EQ(bounds_of(far).min.x, 1e7);
}

TEST(Validate, names_the_offender) {
  Mesh mesh = test::cube();
  mesh.name = "cube";
  mesh.triangles[3][1] = 8;
  const auto r = validate(mesh);
  ASSERT_FALSE(r);
  EXPECT_EQ(r.error().line(), "cube: triangle 3 names wedge 8 of 8");
  mesh = test::cube();
  mesh.positions[2].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(validate(mesh));
  mesh = test::cube_with_seams();
  std::get<std::vector<float>>(mesh.attributes[0].values).pop_back();
  EXPECT_FALSE(validate(mesh));
}

}  // namespace
}  // namespace lodestone
