// What pictures look like, where it can be said in numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/support.h"

namespace lodestone {
namespace {

using render::Shading;
using test::drawn;
using test::flat_camera;
using test::is_mostly;
using test::picture_of;
using test::scene_of;

constexpr std::uint32_t kSide = 16;

// A square over the whole picture with UVs, its material's texture red on the left and green on the right.
Model textured_square() {
  Mesh mesh = test::square(kSide);
  AttributeStream uv = make_stream("TEXCOORD_0", Semantic::uv, 2, ComponentType::float32, false, 4);
  uv.values = std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0};
  mesh.attributes.push_back(uv);
  mesh.groups = {{0, "face"}};
  Model model = make_model(std::move(mesh));
  model.uv_origin_top = true;
  Material material;
  material.name = "paint";
  material.base_color_texture = std::make_shared<const Image>();
  Pixels pixels{2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 255, 0, 0, 255, 0, 255, 0, 255}};
  material.base_color_pixels = std::make_shared<const Pixels>(pixels);
  model.materials.push_back(material);
  return model;
}

Pixels picture_of_square(const Model& model, Shading shading = Shading::textured) {
  return drawn(scene_of(model), flat_camera(kSide), picture_of(kSide, shading));
}

constexpr std::uint32_t kLeft = kSide / 4, kRight = kSide * 3 / 4, kMiddle = kSide / 2;

TEST(Picture, TexturesLieWhereTheirCoordinatesSay) {
  Model model = textured_square();
  Pixels picture = picture_of_square(model);
  EXPECT_TRUE(is_mostly(picture.at(kLeft, kMiddle), 0));
  EXPECT_TRUE(is_mostly(picture.at(kRight, kMiddle), 1));

  model.materials[0].base_color_coordinates.map = {-1, 0, 1, 0, 1, 0};  // mirrored
  picture = picture_of_square(model);
  EXPECT_TRUE(is_mostly(picture.at(kLeft, kMiddle), 1));
  EXPECT_TRUE(is_mostly(picture.at(kRight, kMiddle), 0));

  model.materials[0].base_color_coordinates.map = {0, 1, 0, 1, 0, 0};  // a quarter turn: u runs down
  picture = picture_of_square(model);
  EXPECT_TRUE(is_mostly(picture.at(kMiddle, kLeft), 0));
  EXPECT_TRUE(is_mostly(picture.at(kMiddle, kRight), 1));
}

TEST(Picture, BaseColourTimesTextureTimesVertexColour) {
  Model model = textured_square();
  model.materials[0].base_color = {0, 1, 1, 1};  // nothing is left of red
  EXPECT_LT(picture_of_square(model).at(kLeft, kMiddle)[0], 20);
  model.materials[0].base_color = {1, 1, 1, 1};
  AttributeStream color = make_stream("COLOR_0", Semantic::color, 3, ComponentType::float32, false, 4);
  color.values = std::vector<float>(12, 0);
  model.meshes[0].attributes.push_back(color);
  EXPECT_LT(picture_of_square(model).at(kRight, kMiddle)[1], 20);
}

TEST(Picture, ManyTexelsAPixelAreMixed) {
  Model model = textured_square();
  model.materials[0].base_color_coordinates.map = {997, 0, 0, 0, 997, 0};
  const auto pixel = picture_of_square(model).at(kMiddle, kMiddle);
  EXPECT_NEAR(pixel[0], pixel[1], 12);
  EXPECT_LT(pixel[2], 20);
}

TEST(Picture, MissingTexturesAreMarkedAndTold) {
  Model model = textured_square();
  EXPECT_TRUE(scene_of(model).notes().empty());
  model.materials[0].base_color_pixels = nullptr;
  const render::Scene scene = scene_of(model);
  ASSERT_EQ(scene.notes().size(), 1U);
  EXPECT_NE(scene.notes()[0].find("'paint'"), std::string::npos);
  EXPECT_TRUE(scene.has_textures());
  const Pixels picture = drawn(scene, flat_camera(kSide), picture_of(kSide, Shading::textured));
  EXPECT_NE(picture.at(4, 4), picture.at(5, 4));  // checks of a sixteenth
}

TEST(Picture, AlphaMasksHaveHoles) {
  Model model = textured_square();
  Pixels pixels = *model.materials[0].base_color_pixels;
  pixels.rgba[3] = pixels.rgba[11] = 0;  // the left column
  model.materials[0].base_color_pixels = std::make_shared<const Pixels>(pixels);
  const auto seen = [&] { return test::samples_of(test::frame_of(scene_of(model), flat_camera(kSide), kSide)); };
  EXPECT_EQ(seen(), std::size_t{kSide} * kSide * 4);
  model.materials[0].alpha_cutoff = 0.5F;
  EXPECT_EQ(seen(), std::size_t{kSide} * kSide * 2);
  EXPECT_EQ(picture_of_square(model).at(kLeft, kMiddle), render::RenderOptions{}.background);
}

TEST(Picture, AttributesThatAreNoNumbersDoNoHarm) {
  Model model = textured_square();
  Mesh& mesh = model.meshes[0];
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  mesh.attributes[0].values = std::vector<float>{nan, 1, inf, 1, 1, -inf, 3e38F, -3e38F};
  for (const auto& [name, semantic] : {std::pair{"NORMAL", Semantic::normal}, std::pair{"COLOR_0", Semantic::color}}) {
    AttributeStream stream = make_stream(name, semantic, 3, ComponentType::float32, false, 4);
    stream.values = std::vector<float>{nan, nan, nan, inf, 0, 0, 0, 0, 0, 3e38F, 3e38F, 3e38F};
    mesh.attributes.push_back(stream);
  }
  render::SceneOptions options;
  options.values = {{nan, inf, 1, 2}};
  const render::Scene scene = scene_of(model, options);
  EXPECT_EQ(scene.largest_value(), 2);
  for (const Shading shading : {Shading::smooth, Shading::textured, Shading::normals, Shading::heat}) {
    EXPECT_TRUE(render::render(scene, flat_camera(kSide), picture_of(kSide, shading)).has_value());
  }
}

// Whether the square's middle is drawn as a face seen from behind.
bool seen_from_behind(const Model& model) {
  Camera camera = flat_camera(kSide);
  const auto pixel = drawn(scene_of(model), camera, picture_of(kSide, Shading::smooth)).at(kMiddle, kMiddle);
  return pixel[2] > pixel[0] + 30;
}

TEST(Picture, FacesFromBehindAreMarked) {
  Model model = make_model(test::square(kSide));
  EXPECT_FALSE(seen_from_behind(model));
  std::swap(model.meshes[0].triangles[0][1], model.meshes[0].triangles[0][2]);
  std::swap(model.meshes[0].triangles[1][1], model.meshes[0].triangles[1][2]);
  EXPECT_TRUE(seen_from_behind(model));
  model.meshes[0].groups = {{0, ""}};
  model.materials.resize(1);
  model.materials[0].double_sided = true;
  EXPECT_FALSE(seen_from_behind(model));
}

TEST(Picture, MirroredInstancesKeepTheirFacesOutward) {
  Model model = make_model(test::square(kSide));
  model.instances[0].transform = Mat4d::translation({kSide, 0, 0}) * Mat4d::scale({-1, 1, 1});
  EXPECT_FALSE(seen_from_behind(model));
}

TEST(Picture, NormalsAsColours) {
  const Model model = make_model(test::square(kSide));
  for (const Shading shading : {Shading::normals, Shading::face_normals}) {
    const auto pixel = picture_of_square(model, shading).at(kMiddle, kMiddle);
    EXPECT_NEAR(pixel[0], 128, 1);
    EXPECT_NEAR(pixel[1], 128, 1);
    EXPECT_EQ(pixel[2], 255);
  }
}

TEST(Picture, SharpEdgesStaySharpAndRoundOnesRound) {
  // Seen from above along z, a cube's top has its own normal up to its edges; a sphere's turns.
  render::RenderOptions options = picture_of(64, Shading::normals);
  const render::Scene cube = scene_of(test::cube());
  const Pixels top = drawn(cube, cube.framed({0, 0}, 1, Lens{true, 45}), options);
  EXPECT_EQ(top.at(4, 32), top.at(32, 32));
  const render::Scene ball = scene_of(test::sphere(12));
  const Pixels round = drawn(ball, ball.framed({0, 0}, 1, Lens{true, 45}), options);
  EXPECT_LT(round.at(10, 32)[0], round.at(54, 32)[0] - 100);
}

TEST(Picture, DoesNotDependOnThreads) {
  const render::Scene scene = scene_of(test::torus(80));
  render::RenderOptions options = picture_of(200, Shading::smooth);
  options.wireframe = true;
  const Camera camera = scene.framed({30, 40}, 1);
  const auto with = [&](int threads) {
    return render::render(scene, camera, options, Task::root({}, threads)).value().rgba;
  };
  EXPECT_EQ(with(1), with(2));
  EXPECT_EQ(with(1), with(7));
}

TEST(Picture, ClearBackgroundsHaveSoftEdges) {
  const render::Scene scene = scene_of(test::sphere(20));
  render::RenderOptions options = picture_of(64, Shading::smooth);
  options.background = {0, 0, 0, 0};
  const Pixels picture = drawn(scene, scene.framed({0, 0}, 1), options);
  std::size_t clear = 0, full = 0, partial = 0;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    const std::uint8_t alpha = picture.rgba[i + 3];
    ++(alpha == 0 ? clear : alpha == 255 ? full : partial);
    // Colours are not darkened by what is not there.
    if (alpha != 0) {
      EXPECT_GT(picture.rgba[i], 40);
    }
  }
  EXPECT_GT(clear, 200U);
  EXPECT_GT(full, 2000U);
  EXPECT_GT(partial, 50U);
}

TEST(Picture, WiresAreOnSidesAlone) {
  const render::Scene scene = scene_of(test::square(64));
  render::RenderOptions options = picture_of(64, Shading::flat);
  const Pixels plain = drawn(scene, flat_camera(64), options);
  options.wireframe = true;
  const Pixels wires = drawn(scene, flat_camera(64), options);
  EXPECT_LT(wires.at(32, 31)[1], plain.at(32, 31)[1] - 80);  // the diagonal
  EXPECT_EQ(wires.at(16, 32), plain.at(16, 32));             // the inside
}

TEST(Heat, ColoursFollowTheValuesAndTheLegendTellsThem) {
  const Model model = make_model(test::square(200));
  render::SceneOptions scene_options;
  scene_options.values = {{0, 4, 4, 0}};
  const render::Scene scene = scene_of(model, scene_options);
  EXPECT_EQ(render::default_heat_range(scene).largest, 4);
  render::RenderOptions options = picture_of(200, Shading::heat);
  const Pixels with = drawn(scene, flat_camera(200), options);
  options.legend = false;
  const Pixels without = drawn(scene, flat_camera(200), options);
  EXPECT_GT(without.at(2, 20)[2], without.at(2, 20)[1]);             // violet
  EXPECT_TRUE(without.at(197, 20)[1] > 2 * without.at(197, 20)[2]);  // yellow
  EXPECT_EQ(with.at(20, 20), without.at(20, 20));
  EXPECT_NE(with.at(185, 185), without.at(185, 185));
  options.legend = true;
  options.heat_range = render::HeatRange{0, 8};
  const Pixels wider = drawn(scene, flat_camera(200), options);
  EXPECT_NE(wider.at(197, 20), with.at(197, 20));
}

TEST(Heat, ValuesMustFit) {
  const Model model = make_model(test::cube_with_seams());
  const auto code = [&](std::vector<std::vector<float>> values, std::string attribute) {
    const Result<render::Scene> scene = render::Scene::create(model, {std::move(values), std::move(attribute)});
    return scene ? ErrorCode::empty : scene.error().code;
  };
  EXPECT_EQ(code({std::vector<float>(24)}, ""), ErrorCode::empty);  // one a wedge: no error
  EXPECT_EQ(code({std::vector<float>(8)}, ""), ErrorCode::empty);   // one a vertex
  EXPECT_EQ(code({std::vector<float>(9)}, ""), ErrorCode::bad_argument);
  EXPECT_EQ(code({{}, {}}, ""), ErrorCode::bad_argument);
  EXPECT_EQ(code({}, "_ERROR"), ErrorCode::bad_argument);
  const Result<Pixels> none = render::render(scene_of(model), Camera{}, picture_of(8, Shading::heat));
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, ErrorCode::bad_argument);
}

TEST(Picture, OfNothingIsAnError) {
  const Result<Pixels> picture = render::render(make_model(Mesh{}), Camera{});
  ASSERT_FALSE(picture.has_value());
  EXPECT_EQ(picture.error().code, ErrorCode::empty);
}

}  // namespace
}  // namespace lodestone
