// What users of --only and --join rely on.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>

#include "lodestone/chain/ladder/build_ladder.h"
#include "lodestone/core/parts.h"
#include "support/shapes.h"

namespace lodestone::chain {
namespace {

SimplifyModelOptions quick(std::size_t triangles) {
  SimplifyModelOptions options;
  options.distance.samples = 2000;
  options.target_triangles = triangles;
  return options;
}

// All that a triangle's corners carry, as bytes, from its first corner on.
std::string bytes_of(const Mesh& mesh, std::size_t triangle) {
  std::string out;
  const auto add = [&](const auto& value) { out.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const std::uint32_t w : mesh.triangles[triangle]) {
    add(mesh.positions[mesh.vertex_of(w)]);
    for (const AttributeStream& stream : mesh.attributes) {
      std::visit(
          [&](const auto& values) {
            for (std::size_t k = 0; k < stream.components; ++k) add(values[w * stream.components + k]);
          },
          stream.values);
    }
  }
  return out;
}

// Normals that are a little off, and tangents that are not orthogonal to them: nothing may put them right.
Mesh shaded(Mesh mesh) {
  AttributeStream normal =
      make_stream("NORMAL", Semantic::normal, 3, ComponentType::float32, false, mesh.wedge_count());
  AttributeStream tangent =
      make_stream("TANGENT", Semantic::tangent, 4, ComponentType::float32, false, mesh.wedge_count());
  auto& n = std::get<std::vector<float>>(normal.values);
  auto& t = std::get<std::vector<float>>(tangent.values);
  for (std::size_t w = 0; w < mesh.wedge_count(); ++w) {
    const Vec3f unit = normalized(w % 7 == 0 ? Vec3f{0, 0.2F, -1} : Vec3f{0.1F, 0, 1});
    for (std::size_t k = 0; k < 3; ++k) n[w * 3 + k] = unit[k];
    t[w * 4] = t[w * 4 + 3] = 1;
  }
  mesh.attributes = {normal, tangent};
  return mesh;
}

TEST(Only, all_other_triangles_stay_to_the_bit) {
  const Mesh mesh = test::with_uv_seam(shaded(test::grid(30, 0.1F)));
  SimplifyModelOptions options = quick(1000);
  options.constraints.only = {{0, 299}, {700, 1399}};
  for (const bool keep_area : {false, true}) {
    options.constraints.keep_area = keep_area;
    const auto r = simplify_model(make_model(mesh), options);
    ASSERT_TRUE(r);
    EXPECT_LE(r->level.triangles, 1000U) << r->shortfall;
    const Mesh& after = r->level.model.meshes[0];
    std::map<std::string, int> left;
    for (std::size_t t = 0; t < after.triangles.size(); ++t) ++left[bytes_of(after, t)];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (t < 300 || (t >= 700 && t < 1400)) continue;
      EXPECT_EQ(left[bytes_of(mesh, t)], 1) << t;
    }
  }
}

TEST(Only, doubled_and_degenerate_triangles_outside_the_list_stay_too) {
  Mesh mesh = test::grid(10);
  mesh.triangles.push_back(mesh.triangles[150]);
  mesh.triangles.push_back({3, 3, 4});
  SimplifyModelOptions options = quick(150);
  options.constraints.only = {{0, 99}};
  const auto r = simplify_model(make_model(mesh), options);
  ASSERT_TRUE(r);
  const Mesh& after = r->level.model.meshes[0];
  EXPECT_EQ(r->level.triangles, after.triangles.size());
  ASSERT_GE(after.triangles.size(), 102U);
  EXPECT_EQ(bytes_of(after, after.triangles.size() - 1), bytes_of(mesh, 201));
  EXPECT_EQ(bytes_of(after, after.triangles.size() - 2), bytes_of(mesh, 150));
}

TEST(Only, welding_and_joining_leave_the_others_where_they_are) {
  Mesh mesh = test::grid(10);
  const Mesh more = test::grid(10);
  for (const Vec3f& p : more.positions) mesh.positions.push_back(p + Vec3f{1.0005F, 0, 0});
  for (const Triangle& t : more.triangles) mesh.triangles.push_back({t[0] + 121, t[1] + 121, t[2] + 121});
  for (const bool join : {false, true}) {
    SimplifyModelOptions options = quick(260);
    options.constraints.only = {{0, 199}};
    (join ? options.constraints.join_length : options.constraints.weld_tolerance) = 0.002;
    const auto r = simplify_model(make_model(mesh), options);
    ASSERT_TRUE(r);
    const Mesh& after = r->level.model.meshes[0];
    EXPECT_EQ(parts_of(after).count, 1U);
    for (std::size_t t = 0; t < 200; ++t) {
      EXPECT_EQ(bytes_of(after, after.triangles.size() - 200 + t), bytes_of(mesh, 200 + t));
    }
  }
}

TEST(Join, neighbouring_pieces_collapse_as_one) {
  Mesh mesh;  // a floor of 8 x 8 tiles, a little apart
  for (int i = 0; i < 64; ++i) {
    const Mesh tile = test::grid(2);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3f& p : tile.positions) {
      mesh.positions.push_back(p + Vec3f{1.001F * static_cast<float>(i % 8), 1.001F * static_cast<float>(i / 8), 0});
    }
    for (const Triangle& t : tile.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  SimplifyModelOptions options = quick(20);
  const auto apart = simplify_model(make_model(mesh), options);
  ASSERT_TRUE(apart);
  EXPECT_FALSE(apart->shortfall.empty());
  options.constraints.join_length = 0.01;
  const auto r = simplify_model(make_model(mesh), options);
  ASSERT_TRUE(r);
  EXPECT_TRUE(r->shortfall.empty()) << r->shortfall;
  EXPECT_LE(r->level.error.measured_error, 0.02);
}

}  // namespace
}  // namespace lodestone::chain
