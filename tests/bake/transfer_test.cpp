#include "lodestone/bake/transfer.h"

#include <gtest/gtest.h>

#include "bake/shapes.h"
#include "lodestone/core/srgb.h"
#include "lodestone/core/validate.h"

namespace lodestone::bake {
namespace {

Mesh transferred(const Mesh& target, const Model& from, const TransferOptions& options = {}, int threads = 0) {
  const Result<BakeSource> source = BakeSource::create(from, Task::root({}, threads));
  EXPECT_TRUE(source) << source.error().line();
  Result<Mesh> mesh = transfer_attributes(target, *source, options, Task::root({}, threads));
  EXPECT_TRUE(mesh) << mesh.error().line();
  EXPECT_TRUE(validate(*mesh));
  return std::move(*mesh);
}

Vec3d normal_of(const Mesh& mesh, std::size_t wedge) {
  const std::vector<float>& n = test::floats(mesh, Semantic::normal);
  return {double(n[3 * wedge]), double(n[3 * wedge + 1]), double(n[3 * wedge + 2])};
}

// A plate, red above and blue below.
Model two_colored_plate(float thickness) {
  const float z = thickness / 2;
  Mesh mesh = test::make_mesh(
      {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}, {-1, -1, -z}, {1, -1, -z}, {1, 1, -z}, {-1, 1, -z}},
      {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}});
  AttributeStream color = make_stream("COLOR_0", Semantic::color, 3, ComponentType::uint8, true, 8);
  auto& values = std::get<std::vector<float>>(color.values);
  for (std::size_t v = 0; v < 8; ++v) values[3 * v + (v < 4 ? 0 : 2)] = 1;
  mesh.attributes.push_back(std::move(color));
  return make_model(std::move(mesh));
}

TEST(Transfer, takes_normals_from_the_source) {
  const Mesh coarse = test::sphere(12);
  const Mesh got = transferred(coarse, make_model(test::sphere(100)));
  for (std::size_t v = 0; v < coarse.vertex_count(); ++v) {
    EXPECT_GT(dot(normal_of(got, v), normalized(coarse.position(static_cast<std::uint32_t>(v)))), 0.999);
  }
  EXPECT_EQ(find_stream(got, Semantic::color), nullptr) << "white needs no colours";
}

TEST(Transfer, takes_the_targets_own_normal_where_the_sources_points_away) {
  Model inside_out = make_model(test::sphere(60));
  AttributeStream normals =
      make_stream("NORMAL", Semantic::normal, 3, ComponentType::float32, false, inside_out.meshes[0].wedge_count());
  for (std::size_t v = 0; v < inside_out.meshes[0].vertex_count(); ++v) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::get<std::vector<float>>(normals.values)[3 * v + k] = -inside_out.meshes[0].positions[v][k];
    }
  }
  inside_out.meshes[0].attributes.push_back(std::move(normals));
  const Mesh coarse = test::sphere(12);
  const Mesh got = transferred(coarse, inside_out);
  for (std::size_t v = 0; v < coarse.vertex_count(); ++v) {
    EXPECT_GT(dot(normal_of(got, v), normalized(coarse.position(static_cast<std::uint32_t>(v)))), 0.98);
  }
}

TEST(Transfer, colours_are_the_sources_in_16_bits) {
  const Model source = test::with_gradient(test::sphere(80));
  const Mesh coarse = test::sphere(20);
  const Mesh got = transferred(coarse, source);
  const AttributeStream* color = find_stream(got, Semantic::color);
  ASSERT_NE(color, nullptr);
  EXPECT_EQ(color->components, 3U);
  EXPECT_EQ(color->type, ComponentType::uint16);
  EXPECT_TRUE(color->normalized);
  const auto& values = std::get<std::vector<float>>(color->values);
  for (std::size_t v = 0; v < coarse.vertex_count(); ++v) {
    const Vec3f& p = coarse.positions[v];
    EXPECT_NEAR(values[3 * v], light_of_srgb((double(p.x) / 1.05 + 1) / 2), 0.012);
    EXPECT_NEAR(values[3 * v + 1], light_of_srgb((double(p.y) / 1.05 + 1) / 2), 0.012);
    const float whole = values[3 * v] * 65535;
    EXPECT_NEAR(whole, std::round(whole), 0.01);
  }
}

TEST(Transfer, a_thin_wall_keeps_the_colour_of_each_side) {
  const Model plate = two_colored_plate(0.004F);
  // The target is a little thinner and lower, so that its upper side is nearer to the source's lower one.
  const Mesh upper =
      test::make_mesh({{-0.5F, -0.5F, -0.001F}, {0.5F, -0.5F, -0.001F}, {0, 0.5F, -0.001F}}, {{0, 1, 2}});
  const Mesh lower = test::make_mesh({{-0.5F, -0.5F, 0.001F}, {0.5F, -0.5F, 0.001F}, {0, 0.5F, 0.001F}}, {{0, 2, 1}});
  const Mesh red = transferred(upper, plate), blue = transferred(lower, plate);
  for (std::size_t v = 0; v < 3; ++v) {
    EXPECT_EQ(test::floats(red, Semantic::color)[3 * v], 1);
    EXPECT_EQ(test::floats(red, Semantic::color)[3 * v + 2], 0);
    EXPECT_EQ(test::floats(blue, Semantic::color)[3 * v], 0);
    EXPECT_EQ(test::floats(blue, Semantic::color)[3 * v + 2], 1);
  }
}

TEST(Transfer, sees_the_source_where_its_instances_stand) {
  Model model = test::with_gradient(test::sphere(40));
  model.instances = {{0, Mat4d::translation({5, 0, 0}) * Mat4d::scale({-2, 2, 2}), "mirrored"}};
  Mesh target = test::sphere(16);
  for (Vec3f& p : target.positions) p = p * 2.0F + Vec3f{5, 0, 0};
  const Mesh got = transferred(target, model);
  for (std::size_t v = 0; v < target.vertex_count(); ++v) {
    const Vec3d outward = normalized(target.position(static_cast<std::uint32_t>(v)) - Vec3d{5, 0, 0});
    EXPECT_GT(dot(normal_of(got, v), outward), 0.99);
    EXPECT_NEAR(test::floats(got, Semantic::color)[3 * v], light_of_srgb((-outward.x / 1.05 + 1) / 2), 0.02);
  }
}

TEST(Transfer, keeps_the_rest_and_does_what_is_asked) {
  Mesh target = test::cube_with_seams();
  const Model source = test::with_gradient(test::sphere(20));
  const Mesh got = transferred(target, source, {false, true});
  EXPECT_EQ(got.triangles, target.triangles);
  EXPECT_EQ(test::floats(got, Semantic::normal), test::floats(target, Semantic::normal));
  EXPECT_EQ(test::floats(got, Semantic::uv), test::floats(target, Semantic::uv));
  EXPECT_NE(find_stream(got, Semantic::color), nullptr);
  EXPECT_EQ(find_stream(transferred(target, source, {true, false}), Semantic::color), nullptr);
  const auto none = transfer_attributes({}, *BakeSource::create(source));
  EXPECT_EQ(none.error().code, ErrorCode::empty);
  EXPECT_EQ(BakeSource::create({}).error().code, ErrorCode::empty);
}

TEST(Transfer, is_the_same_for_any_number_of_threads) {
  const Model source = test::with_gradient(test::bumpy_sphere(60, 0.05));
  const Mesh target = test::sphere(80);
  const Mesh one = transferred(target, source, {}, 1);
  for (const int threads : {2, 7}) {
    const Mesh other = transferred(target, source, {}, threads);
    EXPECT_EQ(test::floats(one, Semantic::normal), test::floats(other, Semantic::normal));
    EXPECT_EQ(test::floats(one, Semantic::color), test::floats(other, Semantic::color));
  }
}

}  // namespace
}  // namespace lodestone::bake
