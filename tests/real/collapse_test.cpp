// Edge collapse on all shared meshes: defects and turned triangles never increase; order and place hardly matter.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "lodestone/base/random.h"
#include "lodestone/core/topology.h"
#include "lodestone/io/read.h"
#include "lodestone/math/triangle.h"
#include "lodestone/measure/distance.h"
#include "lodestone/simplify/collapse/edge_collapse.h"
#include "lodestone/spatial/bvh.h"

namespace lodestone {
namespace {

namespace fs = std::filesystem;

Mesh read_mesh(const fs::path& path) {
  Result<Model> model = io::read_model(path);
  EXPECT_TRUE(model) << path;
  return std::move(model->meshes.at(0));
}

simplify::EdgeCollapseResult simplified(const Mesh& mesh, double ratio) {
  simplify::EdgeCollapseOptions options;
  options.target_triangles =
      std::max<std::size_t>(1, static_cast<std::size_t>(ratio * static_cast<double>(mesh.triangles.size())));
  Result<simplify::EdgeCollapseResult> out = simplify::collapse_edges(mesh, options);
  EXPECT_TRUE(out);
  return std::move(*out);
}

// Triangles with no part of the original near them, within twice the estimated error, that faces the same way.
std::size_t turned(const spatial::Bvh& original, const Mesh& mesh, double error) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle v = mesh.vertices_of(t);
    const Vec3d a = mesh.position(v[0]), b = mesh.position(v[1]), c = mesh.position(v[2]);
    const Vec3d n = scaled_normal(a, b, c);
    if (!(length(n) > 0)) continue;
    count += original.closest_facing((a + b + c) * (1.0 / 3), normalized(n), error).triangle == kNone ? 1 : 0;
  }
  return count;
}

TEST(SharedCollapse, no_new_defects_and_nothing_turned) {
  for (const auto& entry : fs::directory_iterator(fs::path(LODESTONE_SHARED_DATA) / "meshes")) {
    if (!io::is_model_extension(entry.path().extension().string())) continue;
    const Mesh in = read_mesh(entry.path());
    const Topology before = topology_of(in);
    const Result<spatial::Surface> surface = spatial::flatten(make_model(in));
    ASSERT_TRUE(surface);
    const spatial::Bvh tree(*surface);
    for (const double ratio : {0.5, 0.1, 0.01}) {
      const simplify::EdgeCollapseResult out = simplified(in, ratio);
      const Topology after = topology_of(out.mesh);
      const std::string where = entry.path().filename().string() + " at " + std::to_string(ratio);
      EXPECT_LE(after.nonmanifold_edges, before.nonmanifold_edges) << where;
      EXPECT_LE(after.duplicate_faces, before.duplicate_faces) << where;
      EXPECT_LE(after.degenerate_triangles, before.degenerate_triangles) << where;
      if (before.nonmanifold_edges > 0) continue;  // where sheets meet, sides are a matter of taste
      const double error = std::max(2 * out.estimated_error, 1e-3 * surface->bounds.diagonal());
      EXPECT_EQ(turned(tree, out.mesh, error), 0U) << where;
    }
  }
}

double mean_error(const Mesh& original, const Mesh& mesh) {
  const auto reference = measure::Reference::create(make_model(original));
  const auto distance = reference->distance_to(make_model(mesh));
  EXPECT_TRUE(distance);
  return distance->mean;
}

// Vertices and triangles in another order, everything else the same.
Mesh shuffled(const Mesh& in, std::uint64_t seed) {
  const auto order = [&](std::size_t n, std::uint64_t stream) {
    std::vector<std::uint32_t> list(n);
    std::iota(list.begin(), list.end(), 0U);
    std::sort(list.begin(), list.end(), [&](std::uint32_t a, std::uint32_t b) {
      return random_bits(seed + stream, a) < random_bits(seed + stream, b);
    });
    return list;
  };
  Mesh out;
  std::vector<std::uint32_t> name(in.positions.size());
  for (const std::uint32_t v : order(in.positions.size(), 1)) {
    name[v] = static_cast<std::uint32_t>(out.positions.size());
    out.positions.push_back(in.positions[v]);
  }
  for (const std::uint32_t t : order(in.triangles.size(), 2)) {
    const Triangle& c = in.triangles[t];
    out.triangles.push_back({name[c[0]], name[c[1]], name[c[2]]});
  }
  return out;
}

TEST(SharedCollapse, order_and_place_change_the_mean_error_by_less_than_2_percent) {
  for (const char* name : {"horse.ply", "armadillo_100k.ply", "nefertiti.ply"}) {
    const Mesh in = read_mesh(fs::path(LODESTONE_SHARED_DATA) / "meshes" / name);
    const double plain = mean_error(in, simplified(in, 0.1).mesh);
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      const Mesh other = shuffled(in, seed);
      EXPECT_NEAR(mean_error(in, simplified(other, 0.1).mesh) / plain, 1, 0.02) << name << " " << seed;
    }
    Mesh far = in;
    far.offset = {1e6, 1e6, 1e6};
    EXPECT_NEAR(mean_error(far, simplified(far, 0.1).mesh) / plain, 1, 0.02) << name;
  }
}

}  // namespace
}  // namespace lodestone
