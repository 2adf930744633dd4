#include "lodestone/simplify/collapse/edge_collapse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "lodestone/base/random.h"
#include "lodestone/core/topology.h"
#include "lodestone/core/validate.h"
#include "lodestone/math/triangle.h"
#include "support/shapes.h"

namespace lodestone::simplify {
namespace {

EdgeCollapseResult collapse(const Mesh& mesh, std::size_t target, bool keep_border = false) {
  EdgeCollapseOptions options;
  options.target_triangles = target;
  options.keep_border = keep_border;
  options.record_log = true;
  Result<EdgeCollapseResult> r = collapse_edges(mesh, options);
  EXPECT_TRUE(r);
  return std::move(*r);
}

bool equal(const Mesh& a, const Mesh& b) {
  if (a.positions != b.positions || a.triangles != b.triangles || a.wedge_vertex != b.wedge_vertex) return false;
  for (std::size_t i = 0; i < a.attributes.size(); ++i) {
    if (a.attributes[i].values != b.attributes[i].values) return false;
  }
  return true;
}

class EdgeCollapseLaws : public ::testing::TestWithParam<test::Shape> {};

TEST_P(EdgeCollapseLaws, what_comes_out_is_valid_and_no_worse_than_what_went_in) {
  const Mesh in = GetParam().make();
  const Topology before = topology_of(in);
  for (const std::size_t target : {in.triangles.size() / 2, in.triangles.size() / 10 + 1, std::size_t{1}}) {
    const EdgeCollapseResult out = collapse(in, std::max<std::size_t>(1, target));
    ASSERT_TRUE(validate(out.mesh));
    const Topology after = topology_of(out.mesh);
    EXPECT_LE(after.nonmanifold_edges, before.nonmanifold_edges);
    EXPECT_LE(after.duplicate_faces, before.duplicate_faces);
    EXPECT_GT(after.triangles, 0U);
    EXPECT_EQ(out.stop == StopReason::reached_target, out.mesh.triangles.size() <= std::max<std::size_t>(1, target));
    if (GetParam().closed_manifold) {
      EXPECT_TRUE(after.closed);
      EXPECT_TRUE(after.manifold);
      EXPECT_EQ(after.duplicate_faces, 0U);
      EXPECT_EQ(after.components, before.components);
      EXPECT_EQ(after.vertices + after.triangles - after.edges, before.vertices + before.triangles - before.edges);
    }
  }
}

TEST_P(EdgeCollapseLaws, a_prefix_of_the_log_is_the_run_with_that_target) {
  const Mesh in = GetParam().make();
  const EdgeCollapseResult whole = collapse(in, 1);
  const CollapseLog& log = *whole.log;
  for (std::size_t i = 0; i < 5; ++i) {
    const std::size_t count = log.collapses.size() * i / 4;
    const auto replayed = replay(in, log, count);
    ASSERT_TRUE(replayed);
    EXPECT_EQ(replayed->mesh.triangles.size(), log.triangles_after(count));
    const EdgeCollapseResult direct = collapse(in, std::max<std::size_t>(1, log.triangles_after(count)));
    // A target may be reached earlier than by `count` collapses only if some of these took no face along; they all do.
    EXPECT_TRUE(equal(direct.mesh, replayed->mesh));
    EXPECT_EQ(direct.origin, replayed->origin);
  }
  for (std::size_t i = 1; i < log.collapses.size(); ++i) {
    EXPECT_GE(log.collapses[i].error, log.collapses[i - 1].error);
    EXPECT_GT(log.collapses[i].faces, 0U);
  }
}

TEST_P(EdgeCollapseLaws, undoing_the_log_gives_back_the_positions) {
  const Mesh in = GetParam().make();
  const CollapseLog log = *collapse(in, 1).log;
  std::vector<Vec3f> positions = in.positions;
  for (const Collapse& c : log.collapses) positions[c.kept] = c.position;
  for (std::size_t i = log.collapses.size(); i-- > 0;) {
    EXPECT_EQ(positions[log.collapses[i].kept], log.collapses[i].position);
    positions[log.collapses[i].kept] = log.collapses[i].kept_before;
  }
  EXPECT_EQ(positions, in.positions);
}

TEST_P(EdgeCollapseLaws, the_same_bytes_with_any_threads) {
  const Mesh in = GetParam().make();
  EdgeCollapseOptions options;
  options.target_triangles = in.triangles.size() / 4 + 1;
  const auto one = collapse_edges(in, options, Task::root({}, 1)),
             seven = collapse_edges(in, options, Task::root({}, 7));
  ASSERT_TRUE(one && seven);
  EXPECT_TRUE(equal(one->mesh, seven->mesh));
}

TEST_P(EdgeCollapseLaws, origins_name_triangles_of_the_input) {
  const Mesh in = GetParam().make();
  const EdgeCollapseResult out = collapse(in, in.triangles.size() / 3 + 1);
  ASSERT_EQ(out.origin.size(), out.mesh.triangles.size());
  for (std::size_t i = 0; i < out.origin.size(); ++i) {
    EXPECT_LT(out.origin[i], in.triangles.size());
  }
  EXPECT_TRUE(std::is_sorted(out.origin.begin(), out.origin.end())) << "in the input's order";
}

INSTANTIATE_TEST_SUITE_P(AllShapes, EdgeCollapseLaws, ::testing::ValuesIn(test::small_shapes()),
                         [](const auto& param) { return param.param.name; });

// By what the log says became of each input vertex, not by where it lies.
TEST_P(EdgeCollapseLaws, vertex_origins_name_what_others_collapsed_into) {
  const Mesh in = GetParam().make();
  const EdgeCollapseResult out = collapse(in, in.triangles.size() / 3 + 1);
  ASSERT_EQ(out.vertex_origin.size(), out.mesh.vertex_count());
  EXPECT_TRUE(std::is_sorted(out.vertex_origin.begin(), out.vertex_origin.end()));
  const std::size_t count = out.log->prefix_for(in.triangles.size() / 3 + 1);
  std::vector<std::uint32_t> fate(in.vertex_count());
  std::iota(fate.begin(), fate.end(), 0U);
  for (std::size_t i = count; i-- > 0;) fate[out.log->collapses[i].removed] = fate[out.log->collapses[i].kept];
  for (std::size_t t = 0; t < out.mesh.triangles.size(); ++t) {
    const Triangle now = out.mesh.vertices_of(t), then = in.vertices_of(out.origin[t]);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(out.vertex_origin[now[k]], fate[then[k]]);
  }
}

TEST(EdgeCollapse, many_ranges_give_the_same_bytes_and_stay_closed) {
  const Mesh in = test::torus(160);  // 51,200 triangles: several ranges of vertices
  EdgeCollapseOptions options;
  options.target_triangles = 4000;
  const auto one = collapse_edges(in, options, Task::root({}, 1)), two = collapse_edges(in, options, Task::root({}, 2)),
             seven = collapse_edges(in, options, Task::root({}, 7));
  ASSERT_TRUE(one && two && seven);
  EXPECT_TRUE(equal(one->mesh, two->mesh));
  EXPECT_TRUE(equal(one->mesh, seven->mesh));
  const Topology t = topology_of(one->mesh);
  EXPECT_TRUE(t.closed && t.manifold);
  EXPECT_NEAR(volume_of(one->mesh) / volume_of(in), 1, 1e-4) << "the placement keeps the volume";
}

// The record tells collapses of different ranges by cost, not in the order in which they were done.
TEST(EdgeCollapse, every_prefix_over_many_ranges_is_closed_and_manifold) {
  const Mesh in = test::torus(160);
  const EdgeCollapseResult out = collapse(in, 400);
  ASSERT_TRUE(out.log);
  for (std::size_t share = 1; share <= 20; ++share) {
    const std::size_t count = out.log->collapses.size() * share / 20;
    const Result<ReplayResult> at = replay(in, *out.log, count);
    ASSERT_TRUE(at);
    EXPECT_EQ(at->mesh.triangles.size(), out.log->triangles_after(count));
    const Topology topology = topology_of(at->mesh);
    EXPECT_TRUE(topology.closed && topology.manifold) << count << " collapses";
    EXPECT_EQ(topology.duplicate_faces, 0U);
  }
}

TEST(EdgeCollapse, soups_never_get_worse) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const Mesh in = test::soup(seed, 8 + static_cast<int>(seed), 40 + 3 * static_cast<int>(seed));
    const Topology before = topology_of(in);
    const EdgeCollapseResult out = collapse(in, 1);
    ASSERT_TRUE(validate(out.mesh)) << seed;
    const Topology after = topology_of(out.mesh);
    EXPECT_LE(after.nonmanifold_edges, before.nonmanifold_edges) << seed;
    EXPECT_LE(after.duplicate_faces, before.duplicate_faces) << seed;
  }
}

TEST(EdgeCollapse, flat_parts_cost_nothing_and_outlines_stay) {
  const Mesh in = test::grid(20);
  const EdgeCollapseResult out = collapse(in, 2);
  EXPECT_LE(out.mesh.triangles.size(), 8U);
  EXPECT_NEAR(area_of(out.mesh), 1, 1e-5);
  EXPECT_LT(out.estimated_error, 1e-5);
}

// Two separate plates 1e-3 apart: as they are, far away, and turned. All costs are 0 or noise.
TEST(EdgeCollapse, offset_plates_reach_their_outlines_without_folds) {
  const double cx = std::cos(30 * 3.14159265358979 / 180), sx = std::sin(30 * 3.14159265358979 / 180);
  const double cy = std::cos(20 * 3.14159265358979 / 180), sy = std::sin(20 * 3.14159265358979 / 180);
  for (int variant = 0; variant < 3; ++variant) {
    Mesh in = test::offset_plates(100);
    for (Vec3f& p : in.positions) {
      if (variant == 1) p += {1e4F, 1e4F, 1e4F};
      if (variant == 2) {
        const Vec3d q{p.x, cx * p.y - sx * p.z, sx * p.y + cx * p.z};
        p = to_float(Vec3d{cy * q.x + sy * q.z, q.y, -sy * q.x + cy * q.z});
      }
    }
    for (const std::size_t target : {std::size_t{900}, std::size_t{400}}) {
      const EdgeCollapseResult out = collapse(in, target);
      EXPECT_EQ(out.stop, StopReason::reached_target) << variant;
      EXPECT_NEAR(area_of(out.mesh), 2, 2e-3) << variant << " " << target;
      Vec3d up{};
      double turned = 0;  // area that faces the other way than its plate
      for (std::size_t t = 0; t < out.mesh.triangles.size(); ++t) {
        const Triangle v = out.mesh.vertices_of(t), o = in.vertices_of(out.origin[t]);
        const Vec3d n = scaled_normal(out.mesh.position(v[0]), out.mesh.position(v[1]), out.mesh.position(v[2]));
        const Vec3d m = scaled_normal(in.position(o[0]), in.position(o[1]), in.position(o[2]));
        if (dot(n, m) < 0) turned += length(n) / 2;
        up += n;
      }
      EXPECT_LT(turned, variant == 1 ? 1e-4 : 1e-7) << variant << " " << target;  // at 1e4 a float is a tenth of a cell
    }
  }
}

TEST(EdgeCollapse, coordinates_at_the_end_of_float_stay_finite) {
  Mesh in = test::torus(24);
  float most = 0;
  for (const Vec3f& p : in.positions) most = std::max({most, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  for (Vec3f& p : in.positions) p = p * (std::numeric_limits<float>::max() / most * 0.999F);
  for (const std::size_t target : {500U, 100U, 1U}) {
    for (const Vec3f& p : collapse(in, target).mesh.positions) EXPECT_TRUE(is_finite(p));
  }
}

TEST(EdgeCollapse, no_triangle_is_left_without_area) {
  Mesh in = test::torus(96);
  for (Vec3f& p : in.positions) p.z = p.z > 0 ? 0.125F : -0.125F;  // flats, where collapses cost nothing
  for (const double share : {0.5, 0.2, 0.05}) {
    const Mesh out = collapse(in, static_cast<std::size_t>(static_cast<double>(in.triangles.size()) * share)).mesh;
    EXPECT_LE(topology_of(out).degenerate_triangles, topology_of(in).degenerate_triangles);
  }
}

TEST(EdgeCollapse, moving_the_mesh_moves_the_result) {
  const Mesh in = test::torus(40);
  Mesh far = in;
  far.offset = {1e6, 1e6, 1e6};
  EXPECT_EQ(collapse(in, 400).mesh.positions, collapse(far, 400).mesh.positions);
}

TEST(EdgeCollapse, borders_and_requests_hold) {
  const Mesh in = test::grid(16, 0.2F);
  const EdgeCollapseResult out = collapse(in, 1, true);
  EXPECT_EQ(topology_of(out.mesh).boundary_edges, 64U);
  EXPECT_EQ(out.locked.border, 64U);
  EdgeCollapseOptions options;
  options.target_triangles = 10;
  options.no_move.assign(in.vertex_count(), 0);
  options.no_move[100] = 1;
  const auto locked = collapse_edges(in, options);
  ASSERT_TRUE(locked);
  EXPECT_EQ(std::count(locked->mesh.positions.begin(), locked->mesh.positions.end(), in.positions[100]), 1);
}

// Along x = 0.5 a seam with a jump of 2 in u: no UV may end up between the charts, and the seam stays where it was.
TEST(EdgeCollapse, sheets_with_a_face_on_either_side_collapse_with_both) {
  Mesh in = test::torus(48);
  const std::size_t one_side = in.triangles.size();
  for (std::size_t t = 0; t < one_side; ++t) {
    const Triangle v = in.triangles[t];
    in.triangles.push_back({v[0], v[2], v[1]});
  }
  const EdgeCollapseResult out = collapse(in, one_side / 5);
  EXPECT_EQ(out.stop, StopReason::reached_target);
  EXPECT_LE(out.mesh.triangles.size(), one_side / 5);
  EXPECT_GE(out.mesh.triangles.size() + 4, one_side / 5);
  std::size_t fronts = 0;
  for (const std::uint32_t from : out.origin) fronts += from < one_side ? 1 : 0;
  EXPECT_EQ(2 * fronts, out.mesh.triangles.size()) << "each face has kept its back";
  EXPECT_EQ(out.locked.non_manifold, 0U);
}

TEST(EdgeCollapse, weights_keep_triangles_where_they_are_wanted) {
  const Mesh in = test::torus(96);
  EdgeCollapseOptions options;
  options.target_triangles = in.triangles.size() / 10;
  options.weights.assign(in.vertex_count(), 1);
  const auto in_half = [](const Mesh& mesh) {
    std::size_t count = 0;
    for (const Vec3f& p : mesh.positions) count += p.x > 0 ? 1 : 0;
    return static_cast<double>(count) / static_cast<double>(mesh.vertex_count());
  };
  const auto even = collapse_edges(in, options);
  for (std::size_t v = 0; v < in.vertex_count(); ++v) options.weights[v] = in.positions[v].x > 0 ? 100.0F : 1.0F;
  const auto weighted = collapse_edges(in, options);
  ASSERT_TRUE(even && weighted);
  EXPECT_NEAR(in_half(even->mesh), 0.5, 0.05);
  EXPECT_GT(in_half(weighted->mesh), 0.75);
  options.weights.pop_back();
  EXPECT_EQ(collapse_edges(in, options).error().code, ErrorCode::bad_argument);
  options.weights.push_back(-1);
  EXPECT_EQ(collapse_edges(in, options).error().code, ErrorCode::bad_argument);
}

TEST(EdgeCollapse, seams_collapse_along_themselves) {
  const Mesh in = test::with_uv_seam(test::grid(20, 0.1F));
  const EdgeCollapseResult out = collapse(in, 60);
  EXPECT_EQ(out.stop, StopReason::reached_target);
  const auto& uv = std::get<std::vector<float>>(out.mesh.attributes[0].values);
  for (std::size_t t = 0; t < out.mesh.triangles.size(); ++t) {
    double low = 1e9, high = -1e9;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t w = out.mesh.triangles[t][k];
      const Vec3f p = out.mesh.positions[out.mesh.vertex_of(w)];
      const float u = uv[2 * w] > 1.2F ? uv[2 * w] - 2 : uv[2 * w];
      EXPECT_NEAR(u, p.x, 0.08) << "UVs follow the surface";
      EXPECT_NEAR(uv[2 * w + 1], p.y, 0.08);
      low = std::min<double>(low, uv[2 * w]);
      high = std::max<double>(high, uv[2 * w]);
    }
    EXPECT_LT(high - low, 1.2) << "no triangle crosses the seam";
  }
}

// Every face with its own normals (as faceted exports have them) must not lock the mesh; the result is faceted again.
TEST(EdgeCollapse, split_normals_do_not_lock) {
  const Mesh smooth = test::sphere(16);
  Mesh in;
  in.positions = smooth.positions;
  std::vector<float> normals;
  for (std::size_t t = 0; t < smooth.triangles.size(); ++t) {
    const Triangle v = smooth.vertices_of(t);
    const Vec3f n =
        to_float(normalized(scaled_normal(smooth.position(v[0]), smooth.position(v[1]), smooth.position(v[2]))));
    Triangle w{};
    for (std::size_t k = 0; k < 3; ++k) {
      w[k] = static_cast<std::uint32_t>(in.wedge_vertex.size());
      in.wedge_vertex.push_back(v[k]);
      normals.insert(normals.end(), {n.x, n.y, n.z});
    }
    in.triangles.push_back(w);
  }
  in.attributes.push_back(make_stream("NORMAL", Semantic::normal, 3, ComponentType::float32, false, 0));
  in.attributes[0].values = normals;
  const EdgeCollapseResult out = collapse(in, 120);
  EXPECT_EQ(out.stop, StopReason::reached_target);
  const auto& n = std::get<std::vector<float>>(out.mesh.attributes[0].values);
  for (std::size_t t = 0; t < out.mesh.triangles.size(); ++t) {
    const Triangle v = out.mesh.vertices_of(t);
    const Vec3d face =
        normalized(scaled_normal(out.mesh.position(v[0]), out.mesh.position(v[1]), out.mesh.position(v[2])));
    for (const std::uint32_t w : out.mesh.triangles[t]) {
      EXPECT_NEAR(dot(face, Vec3d{n[3 * w], n[3 * w + 1], n[3 * w + 2]}), 1, 1e-3);
    }
  }
}

TEST(EdgeCollapse, material_borders_hold) {
  Mesh in = test::grid(16);
  in.groups = {{0, "left"}, {1, "right"}};
  for (std::size_t t = 0; t < in.triangles.size(); ++t) {
    float x = 0;
    for (const std::uint32_t v : in.triangles[t]) x += in.positions[v].x / 3;
    in.face_group.push_back(x < 0.5F ? 0 : 1);
  }
  const EdgeCollapseResult out = collapse(in, 12);
  double area[2] = {0, 0};
  for (std::size_t t = 0; t < out.mesh.triangles.size(); ++t) {
    const Triangle v = out.mesh.vertices_of(t);
    area[out.mesh.face_group[t]] +=
        length(scaled_normal(out.mesh.position(v[0]), out.mesh.position(v[1]), out.mesh.position(v[2]))) / 2;
  }
  EXPECT_NEAR(area[0], 0.5, 1e-4);
  EXPECT_NEAR(area[1], 0.5, 1e-4);
}

TEST(EdgeCollapse, a_fan_of_many_triangles_takes_bounded_time) {
  Mesh in;
  in.positions.push_back({0, 0, 1});
  const int n = 20'000;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * 3.14159265358979 * i / n;
    in.positions.push_back(to_float(Vec3d{std::cos(a), std::sin(a), 0}));
    in.triangles.push_back({0, static_cast<std::uint32_t>(1 + i), static_cast<std::uint32_t>(1 + (i + 1) % n)});
  }
  EXPECT_TRUE(validate(collapse(in, 100).mesh));
}

TEST(EdgeCollapse, bad_arguments_and_cancelling) {
  const Mesh in = test::torus(12);
  EXPECT_EQ(collapse_edges(in, {}).error().code, ErrorCode::bad_argument);
  EdgeCollapseOptions options;
  options.target_triangles = 10;
  options.no_move = {1, 2};
  EXPECT_EQ(collapse_edges(in, options).error().code, ErrorCode::bad_argument);
  options.no_move.clear();
  const Task task = Task::root({});
  task.cancel();
  EXPECT_EQ(collapse_edges(in, options, task).error().code, ErrorCode::cancelled);
}

TEST(EdgeCollapse, the_error_limit_is_an_estimate_that_stops) {
  const Mesh in = test::torus(60);
  EdgeCollapseOptions options;
  options.max_error = 0.002;
  const auto out = collapse_edges(in, options);
  ASSERT_TRUE(out);
  EXPECT_EQ(out->stop, StopReason::error_limit);
  EXPECT_LE(out->estimated_error, 0.002);
  EXPECT_LT(out->mesh.triangles.size(), in.triangles.size());
}

}  // namespace
}  // namespace lodestone::simplify
