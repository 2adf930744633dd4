// The guards of edge collapse on meshes made to break them, many of each kind.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "lodestone/base/random.h"
#include "lodestone/core/topology.h"
#include "lodestone/core/validate.h"
#include "lodestone/math/triangle.h"
#include "lodestone/simplify/collapse/edge_collapse.h"
#include "support/shapes.h"

namespace lodestone::simplify {
namespace {

float uniform(std::uint64_t seed, std::uint64_t i) { return static_cast<float>(random_unit(seed, i)); }

Mesh shaken(Mesh mesh, unsigned seed, float by) {
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3f d{uniform(seed, 3 * v) - 0.5F, uniform(seed, 3 * v + 1) - 0.5F, uniform(seed, 3 * v + 2) - 0.5F};
    mesh.positions[v] += d * by;
  }
  return mesh;
}

// Patches of a grid that touch in single vertices only: a chain of bow-ties.
Mesh bow_ties(unsigned seed) {
  Mesh out;
  const Mesh patch = test::grid(4, 0.1F);
  for (int i = 0; i < 5; ++i) {
    std::vector<std::uint32_t> name(patch.positions.size());
    for (std::size_t v = 0; v < patch.positions.size(); ++v) {
      const Vec3f p = patch.positions[v] + Vec3f{static_cast<float>(i), static_cast<float>(i), 0};
      const auto same = std::find_if(out.positions.begin(), out.positions.end(),
                                     [&](const Vec3f& q) { return length_sq(p - q) < 1e-6F; });
      name[v] = static_cast<std::uint32_t>(same - out.positions.begin());
      if (same == out.positions.end()) out.positions.push_back(p);
    }
    for (const Triangle& t : patch.triangles) out.triangles.push_back({name[t[0]], name[t[1]], name[t[2]]});
  }
  return shaken(std::move(out), seed, 0.02F);
}

// A hub with many blades, its rim closed or open.
Mesh fan(unsigned seed, bool closed) {
  const int blades = 5 + static_cast<int>(60 * uniform(seed, 7));
  Mesh out;
  out.positions.push_back({0, 0, 0.2F});
  for (int i = 0; i < blades; ++i) {
    const double angle = 6.283185307 * i / blades * (closed ? 1.0 : 0.8);
    out.positions.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0});
  }
  for (int i = 0; i + (closed ? 0 : 1) < blades; ++i) {
    out.triangles.push_back({0, static_cast<std::uint32_t>(1 + i), static_cast<std::uint32_t>(1 + (i + 1) % blades)});
  }
  return shaken(std::move(out), seed, 0.02F);
}

// A flat strip of needles, up to 1:10,000.
Mesh needles(unsigned seed) {
  const float width = std::pow(10.0F, -4 * uniform(seed, 3));
  Mesh out;
  for (int i = 0; i < 60; ++i) {
    const float x = width * (static_cast<float>(i) + 0.4F * uniform(seed, 100 + static_cast<std::uint64_t>(i)));
    out.positions.push_back({x, 0, 0});
    out.positions.push_back({x + 0.3F * width, 1, 0});
  }
  for (std::uint32_t i = 0; i + 3 < 120; i += 2) {
    out.triangles.push_back({i, i + 2, i + 1});
    out.triangles.push_back({i + 1, i + 2, i + 3});
  }
  return out;
}

Mesh moebius_band(unsigned seed) { return shaken(test::moebius(20 + static_cast<int>(seed)), seed, 0.02F); }
Mesh noisy_torus(unsigned seed) { return shaken(test::torus(12 + static_cast<int>(seed % 17)), seed, 0.05F); }
Mesh random_soup(unsigned seed) {
  return test::soup(seed, 10 + static_cast<int>(seed), 60 + 3 * static_cast<int>(seed));
}

struct Kind {
  const char* name;
  Mesh (*make)(unsigned seed);
  bool flat;  // in z = 0, facing up

  friend std::ostream& operator<<(std::ostream& out, const Kind& kind) { return out << kind.name; }
};

// Pairs of triangles that face each other closer than the angle of a cosine across an edge that just these two share,
// in opposite directions (on a Moebius band there is one where they do not).
std::size_t folds(const Mesh& mesh, double cosine) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::pair<std::size_t, bool>>> sides;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle v = mesh.vertices_of(t);
    for (std::size_t k = 0; k < 3; ++k) sides[std::minmax(v[k], v[(k + 1) % 3])].emplace_back(t, v[k] < v[(k + 1) % 3]);
  }
  const auto normal = [&](std::size_t t) {
    const Triangle v = mesh.vertices_of(t);
    return scaled_normal(mesh.position(v[0]), mesh.position(v[1]), mesh.position(v[2]));
  };
  std::size_t count = 0;
  for (const auto& [edge, triangles] : sides) {
    if (triangles.size() != 2 || triangles[0].second == triangles[1].second) continue;
    const Vec3d n = normal(triangles[0].first), m = normal(triangles[1].first);
    count += dot(n, m) < -cosine * length(n) * length(m) ? 1 : 0;
  }
  return count;
}

class CollapseGuards : public ::testing::TestWithParam<Kind> {};

TEST_P(CollapseGuards, hold_at_every_count) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Mesh in = GetParam().make(seed);
    const Topology before = topology_of(in);
    for (const std::size_t part : {2U, 5U, 20U, 1000U}) {
      EdgeCollapseOptions options;
      options.target_triangles = std::max<std::size_t>(1, in.triangles.size() / part);
      const Result<EdgeCollapseResult> out = collapse_edges(in, options);
      ASSERT_TRUE(out) << seed;
      ASSERT_TRUE(validate(out->mesh)) << seed;
      const Topology after = topology_of(out->mesh);
      EXPECT_LE(after.nonmanifold_edges, before.nonmanifold_edges) << seed << " " << part;
      EXPECT_LE(after.nonmanifold_vertices, before.nonmanifold_vertices) << seed << " " << part;
      EXPECT_LE(after.duplicate_faces, before.duplicate_faces) << seed << " " << part;
      EXPECT_EQ(after.components, before.components) << seed << " " << part;
      if (before.nonmanifold_edges == 0) {
        // 10 degrees; at the end of all collapses 0.1.
        const double cosine = part == 1000 ? 0.999999 : 0.98481;
        EXPECT_LE(folds(out->mesh, cosine), folds(in, cosine)) << seed << " " << part;
      }
      if (before.closed) {
        EXPECT_TRUE(after.closed) << seed << " " << part;
      }
      for (std::size_t t = 0; t < out->mesh.triangles.size() && GetParam().flat; ++t) {
        const Triangle v = out->mesh.vertices_of(t);
        const Mesh& m = out->mesh;
        EXPECT_GT(scaled_normal(m.position(v[0]), m.position(v[1]), m.position(v[2])).z, 0) << seed << " " << part;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, CollapseGuards,
                         ::testing::Values(Kind{"soups", random_soup, false}, Kind{"tori", noisy_torus, false},
                                           Kind{"moebius_bands", moebius_band, false},
                                           Kind{"bow_ties", bow_ties, false},
                                           Kind{"closed_fans", [](unsigned s) { return fan(s, true); }, false},
                                           Kind{"open_fans", [](unsigned s) { return fan(s, false); }, false},
                                           Kind{"needle_strips", needles, true}),
                         [](const auto& tested) { return std::string(tested.param.name); });

// Struts of a lattice, sixty times as long as they are thick: without a way left but to end in blades, they do.
TEST(CollapseThinBars, end_in_a_tetrahedron) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Mesh bar = test::cube();
    for (Vec3f& p : bar.positions) p.y *= 60;
    bar = shaken(std::move(bar), seed, 0.1F);
    EdgeCollapseOptions options;
    options.target_triangles = 4;
    const auto out = collapse_edges(bar, options);
    ASSERT_TRUE(out);
    EXPECT_EQ(out->mesh.triangles.size(), 4U) << seed;
    EXPECT_TRUE(topology_of(out->mesh).closed) << seed;
  }
}

}  // namespace
}  // namespace lodestone::simplify
