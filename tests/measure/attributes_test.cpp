#include "lodestone/measure/attributes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "support/shapes.h"

namespace lodestone::measure {
namespace {

constexpr std::uint64_t kSamples = 20'000;

Attributes measured(const Model& a, const Model& b, int threads = 0) {
  const auto found = attribute_deviation(a, b, {kSamples, 1, {}}, Task::root({}, threads));
  EXPECT_TRUE(found) << found.error().line();
  return found ? *found : Attributes{};
}

Attributes measured(const Mesh& a, const Mesh& b) { return measured(make_model(a), make_model(b)); }

AttributeStream stream(const char* name, Semantic semantic, std::uint32_t components, const Mesh& mesh) {
  return make_stream(name, semantic, components, ComponentType::float32, false, mesh.wedge_count());
}

std::vector<float>& floats(AttributeStream& s) { return std::get<std::vector<float>>(s.values); }

// UVs = (x, y), one tuple a vertex.
Mesh with_uv(Mesh mesh, std::uint32_t set = 0, Vec2f shift = {}) {
  AttributeStream uv = stream("TEXCOORD", Semantic::uv, 2, mesh);
  uv.set = set;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    floats(uv)[2 * v] = mesh.positions[v].x + shift.x;
    floats(uv)[2 * v + 1] = mesh.positions[v].y + shift.y;
  }
  mesh.attributes.push_back(std::move(uv));
  return mesh;
}

Mesh with_color(Mesh mesh, Vec3f color) {
  AttributeStream rgb = stream("COLOR_0", Semantic::color, 3, mesh);
  for (std::size_t i = 0; i < floats(rgb).size(); ++i) floats(rgb)[i] = color[i % 3];
  mesh.attributes.push_back(std::move(rgb));
  return mesh;
}

Mesh with_normal(Mesh mesh, Vec3f normal) {
  AttributeStream n = stream("NORMAL", Semantic::normal, 3, mesh);
  for (std::size_t i = 0; i < floats(n).size(); ++i) floats(n)[i] = normal[i % 3];
  mesh.attributes.push_back(std::move(n));
  return mesh;
}

// One material whose texture has these pixels, row by row from the top.
Model textured(Mesh mesh, std::uint32_t width, std::vector<std::array<std::uint8_t, 3>> pixels) {
  auto image = std::make_shared<Pixels>();
  image->width = width;
  image->height = static_cast<std::uint32_t>(pixels.size()) / width;
  for (const auto& p : pixels) image->rgba.insert(image->rgba.end(), {p[0], p[1], p[2], 255});
  mesh.groups = {{0, ""}};
  Model model = make_model(std::move(mesh));
  model.uv_origin_top = true;
  model.materials.resize(1);
  model.materials[0].base_color_texture = std::make_shared<Image>();
  model.materials[0].base_color_pixels = std::move(image);
  return model;
}

constexpr std::array<std::uint8_t, 3> kBlack{0, 0, 0}, kWhite{255, 255, 255}, kRed{255, 0, 0}, kGrey{128, 128, 128};

TEST(Attributes, a_model_to_itself_is_zero) {
  for (const Mesh& mesh : {test::cube_with_seams(), test::with_uv_seam(test::grid(12, 0.1F)), with_uv(test::torus(16)),
                           with_color(with_uv(test::sphere(12)), {0.2F, 0.4F, 0.6F}), with_uv(test::moebius(40))}) {
    const Attributes d = measured(mesh, mesh);
    EXPECT_LT(d.normal.both.max, 1e-5);
    EXPECT_EQ(d.normal.both.share, 1);
    ASSERT_EQ(d.uv.size(), 1U);
    EXPECT_LT(d.uv[0].distance.both.max, 1e-6);
    EXPECT_EQ(d.uv[0].distance.both.share, 1);
    EXPECT_TRUE(!d.color || d.color->both.max < 1e-6);
    EXPECT_TRUE(d.notes.empty());
  }
}

TEST(Attributes, shifted_uvs_give_the_shift) {
  const Attributes d = measured(with_uv(test::grid(5)), with_uv(test::grid(9), 0, {0.03F, 0.04F}));
  ASSERT_EQ(d.uv.size(), 1U);
  const Deviation& uv = d.uv[0].distance.both;
  for (const double value : {uv.mean, uv.rms, uv.median, uv.percentile_95, uv.max}) EXPECT_NEAR(value, 0.05, 1e-6);
  EXPECT_NEAR(d.uv[0].diagonal, std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(d.uv[0].relative(uv.mean), 0.05 / std::sqrt(2.0), 1e-6);
}

// Half of the square is shifted: half of the samples are.
TEST(Attributes, means_and_percentiles_are_by_area) {
  const Mesh a = with_uv(test::grid(10));
  Mesh b = test::with_uv_seam(test::grid(10));  // right half: u + 2
  const Attributes d = measured(a, b);
  const Deviation& uv = d.uv[0].distance.both;
  EXPECT_NEAR(uv.mean, 1, 0.02);
  EXPECT_NEAR(uv.rms, std::sqrt(2.0), 0.02);
  EXPECT_NEAR(uv.percentile_95, 2, 1e-6);
  EXPECT_NEAR(uv.max, 2, 1e-6);
}

TEST(Attributes, the_origin_of_uvs_does_not_matter) {
  Model top = make_model(with_uv(test::grid(6))), bottom = make_model(with_uv(test::grid(6)));
  top.uv_origin_top = true;
  auto& stream = bottom.meshes[0].attributes[0];
  for (std::size_t i = 1; i < floats(stream).size(); i += 2) floats(stream)[i] = 1 - floats(stream)[i];
  EXPECT_LT(measured(top, bottom).uv[0].distance.both.max, 1e-6);
}

TEST(Attributes, turned_normals_give_the_angle) {
  for (const double degrees : {0.5, 30.0, 90.0, 150.0, 180.0}) {
    const double r = degrees * std::numbers::pi / 180;
    const Mesh turned = with_normal(test::grid(4), to_float(Vec3d{3 * std::sin(r), 0, 3 * std::cos(r)}));
    const Attributes d = measured(with_normal(test::grid(7), {0, 0, 1}), turned);
    EXPECT_NEAR(d.normal.both.mean, degrees, 1e-4);
    EXPECT_NEAR(d.normal.both.max, degrees, 1e-4);
    // Without a stream the faces' own normals are taken, and that is told.
    const Attributes flat = measured(test::grid(7), turned);
    EXPECT_NEAR(flat.normal.both.mean, degrees, 1e-4);
    ASSERT_EQ(flat.notes.size(), 1U);
    EXPECT_NE(flat.notes[0].find("normals"), std::string::npos);
  }
}

TEST(Attributes, normals_go_with_the_instance) {
  Model straight = make_model(with_normal(test::grid(4), {0.6F, 0, 0.8F})), mirrored = straight;
  EXPECT_LT(measured(straight, straight).normal.both.max, 1e-5);
  // A mirror in x turns (0.6, 0, 0.8) into (-0.6, 0, 0.8); scaling by 2 in x halves a normal's x.
  mirrored.instances[0].transform = Mat4d::translation({1, 0, 0}) * Mat4d::scale({-1, 1, 1});
  EXPECT_NEAR(measured(straight, mirrored).normal.both.mean, 2 * std::asin(0.6) * 180 / std::numbers::pi, 1e-4);
  Model wide = straight;
  wide.instances[0].transform = Mat4d::scale({2, 1, 1});
  Model expected = make_model(with_normal(test::grid(4), {0.3F, 0, 0.8F}));
  for (Vec3f& p : expected.meshes[0].positions) p.x *= 2;
  EXPECT_LT(measured(wide, expected).normal.both.max, 1e-4);
}

TEST(Attributes, a_mirrored_instance_keeps_its_uvs) {
  Model plain = make_model(with_uv(test::grid(6, 0.3F))), mirrored = plain;
  for (Vec3f& p : mirrored.meshes[0].positions) p.x = -p.x;
  for (Triangle& t : mirrored.meshes[0].triangles) std::swap(t[1], t[2]);
  mirrored.instances[0].transform = Mat4d::scale({-1, 1, 1});
  EXPECT_LT(measured(plain, mirrored).uv[0].distance.both.max, 1e-6);
}

TEST(Attributes, vertex_colours_in_the_cube_of_rgb) {
  const Attributes d = measured(with_color(test::grid(5), {0, 0, 0}), with_color(test::grid(8), {1, 1, 1}));
  ASSERT_TRUE(d.color);
  EXPECT_NEAR(d.color->both.mean, std::sqrt(3.0), 1e-6);
  ASSERT_TRUE(d.look);
  EXPECT_NEAR(d.look->both.mean, std::sqrt(3.0), 1e-6);
  const Attributes one = measured(with_color(test::grid(5), {0, 0, 0}), test::grid(8));
  EXPECT_FALSE(one.color);
  EXPECT_EQ(one.notes.size(), 1U);
  EXPECT_NEAR(one.look->both.mean, std::sqrt(3.0), 1e-6);  // without colours it is drawn white
}

TEST(Attributes, textures_are_seen_through_uvs) {
  const std::vector<std::array<std::uint8_t, 3>> checks{kBlack, kWhite, kWhite, kBlack};
  const Model a = textured(with_uv(test::grid(8)), 2, checks);
  EXPECT_LT(measured(a, a).look->both.max, 1e-6);
  // Shifted by half the image, black is white: everywhere as far apart as the filter's blend allows.
  const Model b = textured(with_uv(test::grid(8), 0, {0.5F, 0}), 2, checks);
  const Attributes half = measured(a, b);
  EXPECT_GT(half.look->both.max, 1.5);
  EXPECT_GT(half.look->both.mean, 0.25);
  // A whole image further it repeats: the same picture, though the UVs are 1 apart.
  const Attributes whole = measured(a, textured(with_uv(test::grid(8), 0, {1, 0}), 2, checks));
  EXPECT_LT(whole.look->both.max, 1e-5);
  EXPECT_NEAR(whole.uv[0].distance.both.mean, 1, 1e-5);
}

TEST(Attributes, look_multiplies_factor_texture_and_vertex_colour_as_light) {
  // A texture of sRGB 128 lets 0.2159 of the light through, and so does a factor of 0.2159 or a vertex colour.
  const Model texture = textured(with_uv(test::grid(3)), 1, {kGrey});
  Model factor = textured(with_uv(test::grid(3)), 1, {kWhite});
  factor.materials[0].base_color = {0.21586F, 0.21586F, 0.21586F, 1};
  EXPECT_LT(measured(texture, factor).look->both.max, 1e-4);
  const Mesh grey = with_color(with_uv(test::grid(3)), {0.21586F, 0.21586F, 0.21586F});
  EXPECT_LT(measured(texture, make_model(grey)).look->both.max, 1e-4);
}

TEST(Attributes, a_texture_looks_at_its_own_set_and_transform) {
  const std::vector<std::array<std::uint8_t, 3>> halves{kRed, kWhite};  // left red, right white
  const Model a = textured(with_uv(test::grid(4)), 2, halves);
  Model b = textured(with_uv(with_uv(test::grid(4), 0, {9, 9}), 1), 2, halves);
  b.materials[0].base_color_coordinates.set = 1;
  EXPECT_LT(measured(a, b).look->both.max, 1e-5);
  Model c = textured(with_uv(test::grid(4), 0, {0.5F, 0}), 2, halves);
  c.materials[0].base_color_coordinates.map[2] = -0.5;
  EXPECT_LT(measured(a, c).look->both.max, 1e-5);
}

TEST(Attributes, a_missing_texture_counts_as_white_and_is_told) {
  const Model a = textured(with_uv(test::grid(3)), 1, {kBlack});
  Model b = a;
  b.materials[0].name = "skin";
  b.materials[0].base_color_pixels = nullptr;
  const Attributes d = measured(a, b);
  EXPECT_NEAR(d.look->both.mean, std::sqrt(3.0), 1e-6);
  ASSERT_EQ(d.notes.size(), 1U);
  EXPECT_NE(d.notes[0].find("'skin'"), std::string::npos);
}

// Two coincident sheets, front and back with different UVs: a sample is paired with the side that it lies on.
TEST(Attributes, the_back_of_a_sheet_is_not_taken_for_its_front) {
  for (const float gap : {0.0F, 0.001F}) {
    Mesh sheet;
    const Mesh front = with_uv(test::grid(4)), back = with_uv(test::grid(4), 0, {5, 5});
    AttributeStream uv = front.attributes[0];
    floats(uv).insert(floats(uv).end(), floats(const_cast<AttributeStream&>(back.attributes[0])).begin(),
                      floats(const_cast<AttributeStream&>(back.attributes[0])).end());
    sheet.positions = front.positions;
    sheet.triangles = front.triangles;
    for (Vec3f p : back.positions) sheet.positions.push_back({p.x, p.y, p.z - gap});
    for (Triangle t : back.triangles) {
      for (std::uint32_t& v : t) v += static_cast<std::uint32_t>(front.positions.size());
      std::swap(t[1], t[2]);
      sheet.triangles.push_back(t);
    }
    sheet.attributes = {uv};
    EXPECT_LT(measured(sheet, sheet).uv[0].distance.both.max, 1e-6) << gap;
    Mesh moved = sheet;  // by less than 1 % of the diagonal, past the other side
    for (Vec3f& p : moved.positions) p.z += 0.005F;
    EXPECT_LT(measured(sheet, moved).uv[0].distance.both.max, 1e-6) << gap;
  }
}

TEST(Attributes, beside_a_seam_along_an_edge_the_side_is_taken_that_faces_alike) {
  // A cube, and one a little larger: samples beside an edge of the larger are as near to both faces of the smaller.
  const Mesh cube = test::cube_with_seams();
  Mesh larger = cube;
  for (Vec3f& p : larger.positions) p = p * 1.1F - Vec3f{0.05F, 0.05F, 0.05F};
  const Attributes d = measured(cube, larger);
  EXPECT_LT(d.normal.both.max, 1e-5);
  EXPECT_LT(d.uv[0].distance.both.max, 0.08);  // the shift of the corners
}

TEST(Attributes, a_uv_set_that_is_not_there_is_an_error_that_names_those_that_are) {
  const Model a = make_model(with_uv(with_uv(test::grid(3)), 2)), b = make_model(with_uv(test::grid(3)));
  AttributeOptions options{kSamples, 1, 2U};
  const auto missing = attribute_deviation(a, b, options);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::bad_argument);
  EXPECT_EQ(missing.error().what, "B has no UV set 2; those that it has: 0");
  options.uv_set = 1;
  EXPECT_EQ(attribute_deviation(a, b, options).error().what, "A has no UV set 1; those that it has: 0, 2");
  options.uv_set = 0;
  ASSERT_TRUE(attribute_deviation(a, b, options));
  EXPECT_EQ(attribute_deviation(a, b, options)->uv.size(), 1U);
  const Attributes all = measured(a, b);
  ASSERT_EQ(all.uv.size(), 1U);
  EXPECT_EQ(all.notes, std::vector<std::string>{"B has no UV set 2, A has"});
}

TEST(Attributes, values_that_are_not_finite_are_left_out) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
  for (const float bad : {kNan, kInf, -kInf, 3e38F}) {
    Mesh broken = with_normal(with_color(with_uv(test::grid(10)), {0.5F, 0.5F, 0.5F}), {0, 0, 1});
    for (AttributeStream& s : broken.attributes) floats(s)[0] = bad;
    const Model good =
        textured(with_normal(with_color(with_uv(test::grid(10)), {0.5F, 0.5F, 0.5F}), {0, 0, 1}), 1, {kRed});
    const Attributes d = measured(good, textured(broken, 1, {kRed}));
    for (const Deviation* one : {&d.normal.both, &d.uv[0].distance.both, &d.color->both, &d.look->both}) {
      EXPECT_TRUE(std::isfinite(one->mean) && std::isfinite(one->rms) && std::isfinite(one->max));
    }
    EXPECT_LE(d.normal.both.max, 180);
    EXPECT_LE(d.look->both.max, std::sqrt(3.0));
    if (!std::isfinite(bad)) {
      EXPECT_LT(d.uv[0].distance.both.share, 1);
      EXPECT_GT(d.uv[0].distance.both.share, 0.9);
      EXPECT_LT(d.uv[0].distance.both.max, 1e-6);
    }
  }
}

TEST(Attributes, same_figures_for_any_thread_count) {
  const Model a = textured(with_uv(test::torus(40)), 2, {kBlack, kWhite, kRed, kGrey});
  const Model b = textured(with_uv(test::torus(13)), 2, {kBlack, kWhite, kRed, kGrey});
  const Attributes one = measured(a, b, 1);
  for (const int threads : {2, 7}) {
    const Attributes other = measured(a, b, threads);
    const auto same = [](const AttributeFigure& x, const AttributeFigure& y) {
      return x.both.mean == y.both.mean && x.both.rms == y.both.rms && x.both.max == y.both.max &&
             x.both.median == y.both.median && x.both.percentile_95 == y.both.percentile_95 &&
             x.forward.mean == y.forward.mean && x.backward.mean == y.backward.mean;
    };
    EXPECT_TRUE(same(one.normal, other.normal));
    EXPECT_TRUE(same(one.uv[0].distance, other.uv[0].distance));
    EXPECT_TRUE(same(*one.look, *other.look));
  }
}

TEST(Attributes, degenerate_models_and_cancelling) {
  const Mesh point = test::make_mesh({{0, 0, 0}}, {{0, 0, 0}});
  const Attributes d = measured(point, test::cube());
  EXPECT_EQ(d.normal.forward.share, 0);
  EXPECT_TRUE(std::isfinite(d.normal.both.mean));
  Mesh far = test::cube_with_seams();
  for (Vec3f& p : far.positions) p.x += 1e6F;
  EXPECT_TRUE(std::isfinite(measured(test::cube_with_seams(), far).uv[0].distance.both.max));
  EXPECT_FALSE(attribute_deviation(make_model(test::cube()), Model{}));
  const Task task = Task::root({});
  task.cancel();
  const auto cancelled = attribute_deviation(make_model(test::cube()), make_model(test::cube()), {}, task);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace lodestone::measure
