#include "lodestone/core/mesh_arrays.h"

#include <gtest/gtest.h>

#include <limits>

#include "lodestone/core/topology.h"
#include "lodestone/core/validate.h"
#include "support/broken.h"
#include "support/shapes.h"

namespace lodestone {
namespace {

// A square of two triangles, the corners on the diagonal twice, with texture coordinates that differ there.
struct Vertex {
  float position[3];
  float padding;
  float uv[2];
};
const std::vector<Vertex> kVertices{{{0, 0, 0}, 9, {0, 0}},       {{1, 0, 0}, 9, {1, 0}},       {{1, 1, 0}, 9, {1, 1}},
                                    {{0, 0, 0}, 9, {0.5F, 0.5F}}, {{1, 1, 0}, 9, {0.9F, 0.9F}}, {{0, 1, 0}, 9, {0, 1}}};
const std::vector<std::uint32_t> kIndices{0, 1, 2, 3, 4, 5};

MeshArrays square() {
  MeshArrays arrays;
  arrays.vertices = kVertices.size();
  arrays.positions = {kVertices[0].position, sizeof(Vertex)};
  arrays.indices = kIndices;
  arrays.attributes = {{"TEXCOORD_0", Semantic::uv, 0, 2, {kVertices[0].uv, sizeof(Vertex)}}};
  return arrays;
}

TEST(MeshArrays, welded_seams_are_no_cracks) {
  const auto mesh = from_arrays(square());
  ASSERT_TRUE(mesh) << mesh.error().line();
  EXPECT_EQ(mesh->vertex_count(), 4U);
  EXPECT_EQ(mesh->wedge_count(), 6U);
  EXPECT_EQ(topology_of(*mesh).edges, 5U);
}

TEST(MeshArrays, without_welding_vertices_stay_as_they_are) {
  const auto mesh = from_arrays(square(), {.weld = false});
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->vertex_count(), 6U);
  EXPECT_TRUE(mesh->wedge_vertex.empty());
  EXPECT_EQ(topology_of(*mesh).edges, 6U);
}

TEST(MeshArrays, come_back_as_they_went_in) {
  for (const bool weld : {false, true}) {
    const auto mesh = from_arrays(square(), {.weld = weld});
    ASSERT_TRUE(mesh);
    const MeshBuffers out = to_arrays(*mesh);
    ASSERT_EQ(out.indices.size(), kIndices.size());
    ASSERT_EQ(out.attributes.size(), 1U);
    EXPECT_EQ(out.attributes[0].name, "TEXCOORD_0");
    for (std::size_t i = 0; i < kIndices.size(); ++i) {
      const Vertex& in = kVertices[kIndices[i]];
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(out.positions[3 * out.indices[i] + k], in.position[k]);
      for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(out.attributes[0].values[2 * out.indices[i] + k], in.uv[k]);
    }
  }
}

TEST(MeshArrays, of_a_mesh_give_that_mesh_again) {
  const Mesh in = test::cube_with_seams();
  const MeshBuffers buffers = to_arrays(in);
  MeshArrays arrays;
  arrays.vertices = in.wedge_count();
  arrays.positions = {buffers.positions.data()};
  arrays.indices = buffers.indices;
  for (const MeshBuffers::Attribute& a : buffers.attributes) {
    arrays.attributes.push_back({a.name, a.semantic, a.set, a.components, {a.values.data()}});
  }
  const auto out = from_arrays(arrays);
  ASSERT_TRUE(out);
  ASSERT_EQ(out->triangles.size(), in.triangles.size());
  for (std::size_t t = 0; t < in.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(out->positions[out->vertices_of(t)[k]], in.positions[in.vertices_of(t)[k]]);
    }
  }
  EXPECT_EQ(out->vertex_count(), 8U);
}

TEST(MeshArrays, no_vertices_are_an_empty_mesh) {
  const auto mesh = from_arrays({});
  ASSERT_TRUE(mesh);
  EXPECT_TRUE(mesh->triangles.empty());
}

TEST(MeshArrays, what_does_not_fit_is_refused) {
  MeshArrays arrays = square();
  arrays.indices = std::span(kIndices).first(4);
  test::expect_refused(from_arrays(arrays), "mesh arrays: 4 indices are no triples; give three a triangle", "indices");
  arrays = square();
  arrays.vertices = 5;
  test::expect_refused(from_arrays(arrays), "mesh arrays: triangle 1 names vertex 5 of 5; count vertices from 0",
                       "index");
  arrays = square();
  arrays.positions.data = nullptr;
  test::expect_bad_argument(from_arrays(arrays), "no positions");
  for (const std::size_t stride : {std::size_t{8}, std::size_t{13}}) {
    arrays = square();
    arrays.positions.stride_bytes = stride;
    test::expect_bad_argument(from_arrays(arrays), "stride");
  }
  arrays = square();
  arrays.attributes[0].values.data = nullptr;
  test::expect_bad_argument(from_arrays(arrays), "no values");
  arrays = square();
  arrays.attributes[0].components = 0;
  test::expect_bad_argument(from_arrays(arrays), "components");
  arrays = square();
  arrays.attributes[0].semantic = Semantic::joints;
  test::expect_bad_argument(from_arrays(arrays), "joints");
  std::vector<Vertex> broken = kVertices;
  broken[2].position[1] = std::numeric_limits<float>::quiet_NaN();
  arrays = square();
  arrays.positions.data = broken[0].position;
  test::expect_bad_argument(from_arrays(arrays), "position");
  arrays = {};
  arrays.vertices = std::numeric_limits<std::size_t>::max();
  test::expect_bad_argument(from_arrays(arrays), "count");
}

TEST(MeshArrays, cancelled) {
  Task task = Task::root({}, 1);
  task.cancel();
  const auto mesh = from_arrays(square(), {}, task);
  ASSERT_FALSE(mesh);
  EXPECT_EQ(mesh.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace lodestone
