#include "lodestone/simplify/prune/grow_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "lodestone/core/mesh.h"
#include "support/shapes.h"

namespace lodestone::simplify {
namespace {

struct Grown {
  Mesh mesh;
  double area = 0;   // over that before
  double moved = 0;  // farthest
};

// A mesh of one part, grown to `times` its area.
Grown grown(const Mesh& mesh, double times, double most, const Mat4d& metric = {}) {
  PruneOptions options;
  options.metric = metric;
  const PruneOrder thin = *prune_order(mesh, options);
  std::vector<double> area = thin.area;
  for (double& a : area) a *= times;
  std::vector<std::uint32_t> origin(mesh.triangles.size());
  std::iota(origin.begin(), origin.end(), 0U);
  Grown out{mesh};
  grow_parts(mesh, thin, {area, most, metric}, origin, out.mesh);
  out.area = area_of(out.mesh) / area_of(mesh);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    out.moved = std::max(out.moved, length(out.mesh.position(v) - mesh.position(v)));
  }
  return out;
}

Mesh stretched(Mesh mesh, Vec3f by) {
  for (Vec3f& p : mesh.positions) p = {p.x * by.x, p.y * by.y, p.z * by.z};
  return mesh;
}

TEST(GrowParts, leaves_grow_in_their_plane) {
  const Grown leaf = grown(test::grid(4), 4, 10);
  EXPECT_NEAR(leaf.area, 4, 1e-4);
  for (const Vec3f& p : leaf.mesh.positions) EXPECT_EQ(p.z, 0);
  const Grown bent = grown(test::grid(8, 0.05F), 2, 10);
  EXPECT_NEAR(bent.area, 2, 0.05);
}

TEST(GrowParts, struts_grow_across_and_hardly_move) {
  const Grown strut = grown(stretched(test::cube(), {100, 1, 1}), 2, 1000);
  EXPECT_NEAR(strut.area, 2, 0.02);
  EXPECT_LT(strut.moved, 1) << "not by half their length";
}

TEST(GrowParts, round_parts_get_what_they_stand_for_too) {
  const Grown ball = grown(test::sphere(12), 1.5, 10);
  EXPECT_NEAR(ball.area, 1.5, 0.02);
}

TEST(GrowParts, nothing_moves_farther_than_it_may) {
  const Mesh leaf = test::grid(4);
  for (const double most : {0.001, 0.3, 0.5}) EXPECT_LE(grown(leaf, 4, most).moved, most * 1.00001);
  EXPECT_EQ(grown(leaf, 4, 0.001).moved, 0) << "too far for it to make sense";
  EXPECT_GT(grown(leaf, 4, 0.5).moved, 0.4);
  EXPECT_EQ(grown(leaf, 0.5, 1).moved, 0) << "nothing shrinks";
}

TEST(GrowParts, what_is_drawn_stretched_grows_as_it_is_seen) {
  const Mat4d metric = Mat4d::scale({1, 50, 1});  // a square leaf is drawn as a blade
  const Grown blade = grown(test::grid(4), 2, 1000, metric);
  double wide = 0, tall = 0;
  for (const Vec3f& p : blade.mesh.positions) {
    wide = std::max(wide, static_cast<double>(p.x));
    tall = std::max(tall, static_cast<double>(p.y));
  }
  EXPECT_GT(wide, 1.4);
  EXPECT_LT(tall, 1.1);
}

TEST(GrowParts, normals_stay_upright_and_morph_targets_grow_along) {
  Mesh mesh = test::sphere(8);
  AttributeStream normal =
      make_stream("NORMAL", Semantic::normal, 3, ComponentType::float32, false, mesh.wedge_count());
  AttributeStream delta =
      make_stream("POSITION", Semantic::morph_position, 3, ComponentType::float32, false, mesh.wedge_count());
  auto& n = std::get<std::vector<float>>(normal.values);
  auto& d = std::get<std::vector<float>>(delta.values);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    for (std::size_t k = 0; k < 3; ++k) n[v * 3 + k] = d[v * 3 + k] = mesh.positions[v][k];
  }
  mesh = stretched(mesh, {5, 1, 1});
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3f upright = normalized(Vec3f{mesh.positions[v].x / 25, mesh.positions[v].y, mesh.positions[v].z});
    for (std::size_t k = 0; k < 3; ++k) n[v * 3 + k] = upright[k];
  }
  mesh.attributes = {normal, delta};
  const Mesh after = grown(mesh, 2, 1000).mesh;
  const auto& m = std::get<std::vector<float>>(after.attributes[0].values);
  const auto& e = std::get<std::vector<float>>(after.attributes[1].values);
  float a = 0, b = 0;  // half axes along x and across
  for (const Vec3f& p : after.positions) {
    a = std::max(a, p.x);
    b = std::max(b, p.y);
  }
  EXPECT_GT(b, 1.5F);
  for (std::size_t v = 0; v < after.vertex_count(); ++v) {
    const Vec3f p = after.positions[v];
    const Vec3f upright = normalized(Vec3f{p.x / (a * a), p.y / (b * b), p.z / (b * b)});
    EXPECT_GT(dot(upright, Vec3f{m[v * 3], m[v * 3 + 1], m[v * 3 + 2]}), 0.999F);
    EXPECT_NEAR(e[v * 3 + 1], p.y, 0.01F) << "a delta equal to the position is so again";
  }
}

}  // namespace
}  // namespace lodestone::simplify
