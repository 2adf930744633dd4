#include "lodestone/simplify/fit/tracked_level.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lodestone/core/topology.h"
#include "lodestone/simplify/collapse/edge_collapse.h"
#include "lodestone/simplify/fit/split_worst.h"
#include "support/shapes.h"

namespace lodestone::simplify {
namespace {

// A ball with bumps, so that no level is exact.
Mesh bumpy(int rings) {
  Mesh mesh = test::sphere(rings);
  for (Vec3f& p : mesh.positions) {
    p = p * (1 + 0.1F * std::sin(7 * p.x) * std::sin(6 * p.y + 1) * std::sin(5 * p.z + 2));
  }
  return mesh;
}

Mesh collapsed(const Mesh& mesh, std::size_t triangles) {
  EdgeCollapseOptions options;
  options.target_triangles = triangles;
  return collapse_edges(mesh, options)->mesh;
}

TEST(Fit, brings_a_level_nearer_and_keeps_it_whole) {
  const Mesh original = bumpy(60);
  const FitTarget target(original);
  TrackedLevel level(target, collapsed(original, 700), {});
  const double mean = level.mean();
  level.fit({}, {});
  EXPECT_LT(level.mean(), 0.9 * mean);
  const Topology t = topology_of(level.mesh());
  EXPECT_TRUE(t.closed && t.manifold);
  EXPECT_EQ(t.vertices, t.triangles / 2 + 2) << "a sphere still";
  EXPECT_NEAR(volume_of(level.mesh()), volume_of(original), 0.002 * volume_of(original));
}

std::size_t inward(const Mesh& mesh) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle v = mesh.vertices_of(t);
    const Vec3d a = mesh.position(v[0]), b = mesh.position(v[1]), c = mesh.position(v[2]);
    count += dot(cross(b - a, c - a), a + b + c) > 0 ? 0 : 1;
  }
  return count;
}

// Faces of a star-shaped solid look away from its middle.
TEST(Fit, turns_no_face_inward) {
  const Mesh original = bumpy(60);
  const FitTarget target(original);
  for (const bool flips : {false, true}) {
    TrackedLevel level(target, collapsed(original, 700), {});
    for (int i = 1; i < 12; ++i) {
      FitOptions options;
      options.solves = 1 + (flips ? 1 : 0);
      options.flips = flips;
      level.fit(options, {});
      EXPECT_EQ(inward(level.mesh()), 0U) << flips << " " << i;
    }
  }
}

TEST(Fit, leaves_borders_seams_and_locked_vertices) {
  const Mesh original = test::with_uv_seam(test::grid(40, 0.1F));
  const FitTarget target(original);
  const Mesh start = collapsed(original, 300);
  TrackedLevel level(target, start, {});
  FitOptions options;
  options.no_move.assign(start.vertex_count(), 0);
  for (std::size_t v = 0; v < start.vertex_count(); v += 3) options.no_move[v] = 1;
  level.fit(options, {});
  std::size_t moved = 0;
  for (std::size_t v = 0; v < start.vertex_count(); ++v) {
    const Vec3f &a = start.positions[v], &b = level.mesh().positions[v];
    const bool border = a.x <= 0 || a.x >= 1 || a.y <= 0 || a.y >= 1;
    if (border || options.no_move[v] != 0) {
      EXPECT_EQ(a, b) << v;
    }
    moved += a == b ? 0 : 1;
  }
  EXPECT_GT(moved, 0U);
}

TEST(Fit, has_the_same_bytes_for_any_thread_count) {
  const Mesh original = bumpy(60);
  const Mesh start = collapsed(original, 700);
  const auto with = [&](int threads) {
    const Task task = Task::root({}, threads);
    const FitTarget target(original, task);
    TrackedLevel level(target, start, task);
    level.fit({}, task);
    return level.mesh();
  };
  const Mesh one = with(1), seven = with(7);
  EXPECT_EQ(one.positions, seven.positions);
  EXPECT_EQ(one.triangles, seven.triangles);
}

// What is known of an earlier level saves time and changes nothing.
TEST(Fit, measures_again_only_what_changed) {
  const Mesh original = bumpy(60);
  const FitTarget target(original);
  const TrackedLevel before(target, collapsed(original, 900), {});
  Mesh changed = before.mesh();
  for (std::size_t v = 10; v < 14; ++v) changed.positions[v] = changed.positions[v] * 1.1F;
  const TrackedLevel anew(target, changed, {}), updated(target, changed, before, {});
  EXPECT_NEAR(anew.mean(), updated.mean(), 1e-9);
  EXPECT_EQ(anew.max(), updated.max());
  const auto a = anew.worst(), b = updated.worst();
  for (std::size_t t = 0; t < a.size(); ++t) EXPECT_GE(b[t].distance + 1e-9, a[t].distance) << t;
}

TEST(Fit, looks_where_it_is_told) {
  const Mesh original = test::cube();
  Mesh level = original;
  for (Vec3f& p : level.positions) p.z *= 0.5F;  // the top and the bottom are a fourth farther in
  const FitTarget target(original);
  TrackedLevel known(target, level, {});
  const double before = known.max();
  known.probe_error(Vec3d{3, 3, 3}, true, {});
  EXPECT_GT(known.max(), before) << "as far as it was told";
  const std::vector<TriangleError> worst = known.worst();
  EXPECT_TRUE(std::any_of(worst.begin(), worst.end(), [&](const auto& w) { return w.partner == Vec3d{3, 3, 3}; }));
  const double now = known.max();
  known.probe_error(level.position(0), false, {});
  EXPECT_EQ(known.max(), now) << "nothing new there";
}

TEST(Fit, meets_the_volume) {
  const Mesh original = bumpy(60);
  const FitTarget target(original);
  TrackedLevel level(target, collapsed(original, 300), {});
  FitOptions options;
  options.solves = 2;
  level.fit(options, {});
  const double volume = volume_of(original);
  EXPECT_GT(std::abs(volume_of(level.mesh()) - volume), 1e-5 * volume);
  options.solves = 0;
  options.volume = true;
  level.fit(options, {});
  EXPECT_NEAR(volume_of(level.mesh()), volume, 1e-5 * volume);
}

TEST(Fit, textures_do_not_swim) {
  Mesh original = test::with_uv_seam(test::grid(60, 0.2F));
  const FitTarget target(original);
  TrackedLevel level(target, collapsed(original, 400), {});
  level.fit({}, {});
  const Mesh& mesh = level.mesh();
  const AttributeStream* uv = find_stream(mesh, Semantic::uv);
  ASSERT_NE(uv, nullptr);
  // UVs of the original are a linear function of the place in each chart: so must the level's be, about.
  const auto& values = std::get<std::vector<float>>(uv->values);
  const AttributeStream* own = find_stream(original, Semantic::uv);
  const auto& truth = std::get<std::vector<float>>(own->values);
  for (std::uint32_t w = 0; w < mesh.wedge_count(); ++w) {
    const Vec3f p = mesh.positions[mesh.vertex_of(w)];
    float nearest = 10;
    for (std::uint32_t o = 0; o < original.wedge_count(); ++o) {
      const Vec3f q = original.positions[original.vertex_of(o)];
      if (std::abs(p.x - q.x) > 0.02F || std::abs(p.y - q.y) > 0.02F) continue;
      nearest = std::min(nearest, std::hypot(values[2 * w] - truth[2 * o], values[2 * w + 1] - truth[2 * o + 1]));
    }
    EXPECT_LT(nearest, 0.05F) << w;
  }
}

TEST(SplitWorst, adds_triangles_and_keeps_the_surface_whole) {
  const Mesh original = bumpy(60);
  const FitTarget target(original);
  const TrackedLevel level(target, collapsed(original, 700), {});
  const SplitResult split = split_worst(level, {.share = 0.5, .most = 40}, {});
  EXPECT_GT(split.mesh.triangles.size(), level.mesh().triangles.size());
  EXPECT_LE(split.mesh.triangles.size(), level.mesh().triangles.size() + 41);
  const Topology t = topology_of(split.mesh);
  EXPECT_TRUE(t.closed && t.manifold);
  EXPECT_EQ(t.vertices, t.triangles / 2 + 2) << "a sphere still";
}

TEST(SplitWorst, of_neighbours_that_have_been_cut) {
  const Mesh original = bumpy(60);
  const FitTarget target(original);
  for (const std::size_t triangles : {200U, 700U, 2000U}) {
    const TrackedLevel level(target, collapsed(original, triangles), {});
    const SplitResult split = split_worst(level, {.most = level.mesh().triangles.size()}, {});
    EXPECT_GT(split.mesh.triangles.size(), level.mesh().triangles.size());
    const Topology t = topology_of(split.mesh);
    EXPECT_TRUE(t.closed && t.manifold);
    EXPECT_EQ(t.vertices, t.triangles / 2 + 2) << "a sphere still";
  }
}

TEST(Fit, of_nothing_much) {
  for (const Mesh& mesh : {test::tetrahedron(), test::cube(), test::grid(2), test::moebius(12), test::bow_tie(),
                           test::three_faces_on_an_edge(), test::soup(3, 30, 60)}) {
    const FitTarget target(mesh);
    TrackedLevel level(target, mesh, {});
    EXPECT_LT(level.max(), 1e-6);
    level.fit({}, {});
    EXPECT_EQ(level.mesh().triangles.size(), mesh.triangles.size());
    EXPECT_LT(level.max(), 1e-3);
  }
  const Mesh nothing;
  const FitTarget target(nothing);
  TrackedLevel level(target, nothing, {});
  level.fit({}, {});
  EXPECT_EQ(level.max(), 0);
}

}  // namespace
}  // namespace lodestone::simplify
