// Colours that are light, in formats whose colours are what a screen shows.
#include <gtest/gtest.h>

#include "lodestone/core/srgb.h"
#include "lodestone/io/read.h"
#include "lodestone/io/write.h"
#include "support/folder.h"
#include "support/shapes.h"

namespace lodestone::io {
namespace {

class ShownColors : public lodestone::test::InFolder {};

Model lit_by(float light, bool is_light) {
  Mesh mesh = lodestone::test::tetrahedron();
  AttributeStream color = make_stream("COLOR_0", Semantic::color, 3, ComponentType::uint16, true, mesh.wedge_count());
  color.is_light = is_light;
  for (float& value : std::get<std::vector<float>>(color.values)) value = light;
  mesh.attributes.push_back(std::move(color));
  return make_model(std::move(mesh));
}

float color_in(const std::filesystem::path& path) {
  const auto back = read_model(path);
  EXPECT_TRUE(back) << back.error().line();
  const AttributeStream* color = back ? find_stream(back->meshes[0], Semantic::color) : nullptr;
  EXPECT_NE(color, nullptr);
  return color != nullptr ? std::get<std::vector<float>>(color->values).front() : -1;
}

TEST_F(ShownColors, light_comes_out_as_srgb_where_a_format_has_that) {
  const auto grey = static_cast<float>(light_of_byte(128));
  for (const char* name : {"s.ply", "s.obj"}) {
    ASSERT_TRUE(write_model(lit_by(grey, true), folder_ / name));
    EXPECT_NEAR(color_in(folder_ / name), 128.0 / 255, 1e-3) << name;
  }
  ASSERT_TRUE(write_model(lit_by(grey, true), folder_ / "s.glb"));
  EXPECT_NEAR(color_in(folder_ / "s.glb"), grey, 1e-4) << "glTF's colours are light";
}

TEST_F(ShownColors, colours_of_a_mesh_stay_as_they_are) {
  ASSERT_TRUE(write_model(lit_by(0.25F, false), folder_ / "s.ply"));
  EXPECT_NEAR(color_in(folder_ / "s.ply"), 0.25, 1e-4);
}

}  // namespace
}  // namespace lodestone::io
