#include "lodestone/bake/bake.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bake/shapes.h"
#include "lodestone/bake/atlas.h"
#include "lodestone/core/srgb.h"
#include "lodestone/core/validate.h"

namespace lodestone::bake {
namespace {

BakeOptions of_size(std::uint32_t size) {
  BakeOptions options;
  options.texture_size = size;
  return options;
}

struct Set {
  Atlas atlas;
  Baked baked;
};

Set baked(const Mesh& target, const BakeSource& source, std::uint32_t size, int threads = 0) {
  Result<Atlas> atlas = make_atlas(target, {size, 4}, Task::root({}, threads));
  EXPECT_TRUE(atlas) << atlas.error().line();
  Result<Baked> out = bake_textures(atlas->mesh, source, of_size(size), Task::root({}, threads));
  EXPECT_TRUE(out) << out.error().line();
  EXPECT_TRUE(validate(out->mesh));
  return {std::move(*atlas), std::move(*out)};
}

BakeSource source_of(const Model& model) {
  Result<BakeSource> source = BakeSource::create(model);
  EXPECT_TRUE(source) << source.error().line();
  return *source;
}

// Bytes as a viewer's bilinear filter sees them.
Vec3d read_back(const Pixels& pixels, Vec2d uv) {
  const double x = uv.x * pixels.width - 0.5, y = uv.y * pixels.height - 0.5;
  Vec3d out;
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const auto at = [](double p, int n, std::uint32_t size) {
        return static_cast<std::uint32_t>(std::clamp(int(std::floor(p)) + n, 0, int(size) - 1));
      };
      const auto texel = pixels.at(at(x, i, pixels.width), at(y, j, pixels.height));
      const double wx = x - std::floor(x), wy = y - std::floor(y);
      const double weight = (i == 0 ? 1 - wx : wx) * (j == 0 ? 1 - wy : wy);
      out += Vec3d{double(texel[0]), double(texel[1]), double(texel[2])} * weight;
    }
  }
  return out;
}

spatial::SurfacePoint place_of(const BakeSource& source, Vec3d point, Vec3d normal) {
  std::array<spatial::SurfacePoint, 1> place;
  source.find(std::array{point}, std::array{normal}, place);
  return place[0];
}

Vec3d normal_at(const Mesh& mesh, const test::SurfacePoint& spot) {
  const auto n = test::value_at<3>(mesh, Semantic::normal, spot);
  return normalized(Vec3d{n[0], n[1], n[2]});
}

// The normal that a viewer shows.
Vec3d shown_normal(const Set& set, const test::SurfacePoint& spot) {
  const Mesh& mesh = set.baked.mesh;
  const auto uv = test::value_at<2>(mesh, Semantic::uv, spot);
  const auto t = test::value_at<4>(mesh, Semantic::tangent, spot);
  const Vec3d texel = read_back(set.baked.normal_map, {uv[0], uv[1]}) / 255 * 2 - Vec3d{1, 1, 1};
  const Vec3d normal = normal_at(mesh, spot), tangent = normalized(Vec3d{t[0], t[1], t[2]});
  const Vec3d bitangent = normalized(cross(normal, tangent) * t[3]);
  return normalized(tangent * texel.x + bitangent * texel.y + normal * texel.z);
}

TEST(Bake, colours_read_back_on_the_surface_are_the_sources) {
  const Model model = test::with_gradient(test::sphere(80));
  const BakeSource source = source_of(model);
  for (const Mesh& target : {test::sphere(30), test::blob(30, 0.02)}) {
    const Set set = baked(target, source, 512);
    double worst = 0, sum = 0;
    constexpr int kSpots = 20000;
    for (std::uint64_t i = 0; i < kSpots; ++i) {
      const test::SurfacePoint spot = test::random_point(set.baked.mesh, i);
      const auto uv = test::value_at<2>(set.baked.mesh, Semantic::uv, spot);
      const Vec3d seen = read_back(set.baked.base_color, {uv[0], uv[1]});
      const Vec3d light = source.color(place_of(source, test::point_at(target, spot), normal_at(set.baked.mesh, spot)));
      for (std::size_t k = 0; k < 3; ++k) {
        const double off = std::abs(seen[k] - double(byte_of_light(light[k])));
        worst = std::max(worst, off);
        sum += off;
      }
    }
    EXPECT_LE(worst, 2);
    EXPECT_LE(sum / (3 * kSpots), 0.26);
  }
}

TEST(Bake, a_normal_map_brings_the_bumps_back) {
  const Model model = make_model(test::bumpy_sphere(160, 0.03));
  const BakeSource source = source_of(model);
  const Set set = baked(test::sphere(30), source, 1024);
  EXPECT_TRUE(set.baked.base_color.rgba.empty()) << "a white source has no colours";
  double plain = 0, mapped = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const test::SurfacePoint spot = test::random_point(set.baked.mesh, i);
    const Vec3d own = normal_at(set.baked.mesh, spot);
    const Vec3d want = source.normal(place_of(source, test::point_at(set.baked.mesh, spot), own));
    plain += length(own - want);
    mapped += length(shown_normal(set, spot) - want);
  }
  EXPECT_LT(mapped, plain / 42);
}

TEST(Bake, green_points_up_in_the_picture) {
  // A square that looks at +z, textured upright; the source's normal leans towards +y.
  Mesh square = test::grid(2);
  AttributeStream uv = make_stream("TEXCOORD_0", Semantic::uv, 2, ComponentType::float32, false, square.wedge_count());
  for (std::size_t v = 0; v < square.vertex_count(); ++v) {
    std::get<std::vector<float>>(uv.values)[2 * v] = square.positions[v].x;
    std::get<std::vector<float>>(uv.values)[2 * v + 1] = 1 - square.positions[v].y;
  }
  Mesh leaning = square;
  AttributeStream normals =
      make_stream("NORMAL", Semantic::normal, 3, ComponentType::float32, false, square.wedge_count());
  for (std::size_t v = 0; v < square.vertex_count(); ++v) {
    std::get<std::vector<float>>(normals.values)[3 * v + 1] = 0.6F;
    std::get<std::vector<float>>(normals.values)[3 * v + 2] = 0.8F;
  }
  leaning.attributes.push_back(std::move(normals));
  square.attributes.push_back(std::move(uv));
  const Model model = make_model(leaning);
  const Result<Baked> out = bake_textures(square, source_of(model), of_size(64));
  ASSERT_TRUE(out);
  const auto texel = out->normal_map.at(30, 30);
  EXPECT_NEAR(texel[0], 127.5, 1);
  EXPECT_NEAR(texel[1], 127.5 + 0.6 * 127.5, 1);
  EXPECT_NEAR(texel[2], 127.5 + 0.8 * 127.5, 1);
  EXPECT_NEAR(out->covered, 1, 1e-9);
  EXPECT_NEAR(out->max_distance, 0, 1e-6);
}

TEST(Bake, more_looks_average_what_is_finer_than_texels) {
  Model model = test::with_gradient(test::sphere(60), 2);
  auto stripes = std::make_shared<Pixels>(Pixels{512, 1, {}});
  for (std::uint32_t x = 0; x < 512; ++x) {
    const std::uint8_t byte = x % 2 == 0 ? 255 : 0;
    stripes->rgba.insert(stripes->rgba.end(), {byte, byte, byte, 255});
  }
  model.materials[0].base_color_pixels = stripes;
  const BakeSource source = source_of(model);
  const Result<Atlas> atlas = make_atlas(test::sphere(30), {128, 4});
  ASSERT_TRUE(atlas);
  std::array<double, 2> spread{};
  for (const std::uint32_t looks : {1U, 8U}) {
    BakeOptions options;
    options.texture_size = 128;
    options.samples_per_side = looks;
    const Result<Baked> out = bake_textures(atlas->mesh, source, options);
    ASSERT_TRUE(out);
    for (std::size_t i = 0; i < out->base_color.rgba.size(); i += 4) {
      const double off = light_of_byte(out->base_color.rgba[i]) - 0.5;
      spread[looks == 1 ? 0 : 1] += off * off;
    }
  }
  EXPECT_LT(spread[1], spread[0] / 4);
}

TEST(Bake, every_texel_has_a_colour) {
  const Model model = test::with_gradient(test::sphere(40));
  const Set set = baked(test::torus(30), source_of(model), 256);
  EXPECT_NEAR(set.baked.covered, set.atlas.used, 0.02);
  for (std::size_t i = 0; i < set.baked.base_color.rgba.size(); i += 4) {
    EXPECT_EQ(set.baked.base_color.rgba[i + 3], 255);
    EXPECT_EQ(set.baked.normal_map.rgba[i + 3], 255);
    EXPECT_NEAR(set.baked.base_color.rgba[i + 2], 60, 1) << "the blue that all of the source has";
  }
}

TEST(Bake, is_the_same_for_any_number_of_threads) {
  const Model model = test::with_gradient(test::bumpy_sphere(60, 0.05));
  const BakeSource source = source_of(model);
  const Mesh target = test::blob(40, 0.05);
  const Set one = baked(target, source, 256, 1);
  for (const int threads : {2, 7}) {
    const Set other = baked(target, source, 256, threads);
    EXPECT_EQ(one.baked.base_color.rgba, other.baked.base_color.rgba);
    EXPECT_EQ(one.baked.normal_map.rgba, other.baked.normal_map.rgba);
    EXPECT_EQ(one.baked.mean_distance, other.baked.mean_distance);
    for (const Semantic s : {Semantic::normal, Semantic::tangent, Semantic::uv}) {
      EXPECT_EQ(test::floats(one.baked.mesh, s), test::floats(other.baked.mesh, s));
    }
  }
}

TEST(Bake, says_what_is_missing) {
  const Model model = make_model(test::sphere(8));
  const BakeSource source = source_of(model);
  EXPECT_EQ(bake_textures({}, source).error().code, ErrorCode::empty);
  EXPECT_EQ(bake_textures(test::cube(), source).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(bake_textures(test::cube_with_seams(), source, of_size(4)).error().code, ErrorCode::bad_argument);
  Task task = Task::root({});
  task.cancel();
  EXPECT_EQ(bake_textures(test::cube_with_seams(), source, {}, task).error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace lodestone::bake
