#include "lodestone/voxel/sharp_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "lodestone/core/model.h"
#include "lodestone/core/topology.h"
#include "lodestone/spatial/bvh.h"
#include "lodestone/spatial/surface.h"
#include "lodestone/voxel/isosurface.h"
#include "lodestone/voxel/project.h"
#include "lodestone/voxel/resample.h"
#include "lodestone/voxel/voxelize.h"
#include "support/shapes.h"

namespace lodestone::voxel {
namespace {

struct Made {
  SharpSurface sharp;
  double voxel = 0;
};

Made sharp_of(const Mesh& mesh, std::uint32_t resolution, std::uint32_t ratio = 4, int threads = 0) {
  const auto surface = spatial::flatten(make_model(mesh));
  const auto grid = grid_around(surface->bounds, resolution * ratio, ratio);
  VoxelGrid whole = *grid;
  for (std::size_t k = 0; k < 3; ++k) whole.size[k] = (whole.size[k] + ratio - 1) / ratio * ratio;
  const Task task = Task::root({}, threads);
  const auto solid = voxelize(*surface, whole, {}, task);
  const auto shares =
      downsample(solid->volume, {whole.size[0] / ratio, whole.size[1] / ratio, whole.size[2] / ratio}, task);
  const spatial::Bvh tree(*surface);
  auto made = sharp_surface(*shares, tree, {}, task);
  EXPECT_TRUE(made) << made.error().what;
  return {std::move(*made), shares->grid.spacing.x};
}

// How many places hold a vertex.
std::size_t places_of(const Mesh& mesh) {
  std::set<std::array<float, 3>> places;
  for (const Vec3f& p : mesh.positions) places.insert({p.x, p.y, p.z});
  return places.size();
}

// A box turned so that no side lies along the grid.
Mesh turned_box() {
  Mesh box = test::cube();
  const Mat4d turn = Mat4d::rotation(0.18, 0.36, 0.27, std::sqrt(1 - 0.18 * 0.18 - 0.36 * 0.36 - 0.27 * 0.27));
  for (Vec3f& p : box.positions) p = to_float(turn.direction(to_double(p)));
  return box;
}

TEST(SharpSurface, keeps_a_box_a_box) {
  const Mesh box = turned_box();
  const Made made = sharp_of(box, 24);
  const Topology t = topology_of(made.sharp.mesh);
  EXPECT_TRUE(t.closed && t.manifold);
  EXPECT_GT(made.sharp.features, 12U * 8);
  // Rounded edges would lose volume: it is the box's to 0.2 %.
  EXPECT_NEAR(volume_of(made.sharp.mesh), 1.0, 2e-3);
  for (const Vec3f& corner : box.positions) {
    double nearest = 1e9;
    for (std::uint32_t v = 0; v < made.sharp.mesh.vertex_count(); ++v) {
      nearest = std::min(nearest, length(made.sharp.mesh.position(v) - to_double(corner)));
    }
    EXPECT_LT(nearest, 1e-3 * made.voxel) << "each corner of the box is a vertex";
  }
}

TEST(SharpSurface, is_closed_and_manifold_on_noise) {
  std::mt19937 random(5);
  for (int turn = 0; turn < 12; ++turn) {
    ScalarVolume<std::uint8_t> noise;
    noise.grid.size = {9, 11, 8};
    for (std::uint64_t i = 0; i < noise.grid.count(); ++i) noise.values.push_back(static_cast<std::uint8_t>(random()));
    Mesh source = test::sphere(8);
    for (Vec3f& p : source.positions) p = p * 4.0F + Vec3f{4.5F, 5.5F, 4};
    const auto surface = spatial::flatten(make_model(source));
    const spatial::Bvh tree(*surface);
    const auto made = sharp_surface(noise, tree);
    ASSERT_TRUE(made);
    const Topology t = topology_of(made->mesh);
    EXPECT_TRUE(t.closed);
    EXPECT_EQ(t.nonmanifold_edges + t.inconsistent_edges + t.duplicate_faces, 0U) << turn;
    EXPECT_EQ(t.vertices, made->mesh.vertex_count());
    EXPECT_EQ(places_of(made->mesh), made->mesh.vertex_count()) << "whoever welds by position finds it manifold";

    Mesh projected = *isosurface(noise, {127.5});
    project(projected, tree, 2);
    EXPECT_EQ(places_of(projected), projected.vertex_count());
  }
}

TEST(SharpSurface, of_a_sphere_has_no_features) {
  const Made made = sharp_of(test::sphere(40), 32);
  EXPECT_EQ(made.sharp.features, 0U);
  EXPECT_NEAR(volume_of(made.sharp.mesh), volume_of(test::sphere(40)), 0.02);
}

TEST(SharpSurface, has_the_same_bytes_for_any_thread_count) {
  const Mesh box = turned_box();
  const Made one = sharp_of(box, 20, 4, 1), seven = sharp_of(box, 20, 4, 7);
  EXPECT_EQ(one.sharp.mesh.positions, seven.sharp.mesh.positions);
  EXPECT_EQ(one.sharp.mesh.triangles, seven.sharp.mesh.triangles);
}

}  // namespace
}  // namespace lodestone::voxel
