// Colours of scans: from points to the surface and its levels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lodestone/chain/ladder/build_ladder.h"
#include "lodestone/chain/scans/scan_surface.h"
#include "lodestone/core/srgb.h"

namespace lodestone::chain {
namespace {

// A ball around (1000, 0, 0), red where x is above its centre's, of a middle grey below.
PointCloud ball() {
  PointCloud cloud;
  cloud.offset = {1000, 0, 0};
  constexpr std::size_t kPoints = 4000;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double z = 1 - 2 * (static_cast<double>(i) + 0.5) / kPoints, r = std::sqrt(1 - z * z);
    const double t = 2.399963229728653 * static_cast<double>(i);
    const Vec3d p{r * std::cos(t), r * std::sin(t), z};
    cloud.positions.push_back(to_float(p));
    cloud.normals.push_back(to_float(p));
    cloud.colors.push_back(p.x > 0 ? std::array<std::uint8_t, 4>{255, 0, 0, 255}
                                   : std::array<std::uint8_t, 4>{128, 128, 128, 255});
  }
  cloud.file_points = kPoints;
  return cloud;
}

ScanSurfaceOptions coarse() {
  ScanSurfaceOptions options;
  options.resolution = 32;
  return options;
}

// All vertices well beside the border have their side's colour, as light.
void expect_two_colors(const Mesh& mesh, const char* what) {
  const AttributeStream* color = find_stream(mesh, Semantic::color);
  ASSERT_NE(color, nullptr) << what;
  ASSERT_EQ(color->components, 3U);
  const auto& values = std::get<std::vector<float>>(color->values);
  ASSERT_EQ(values.size(), 3 * mesh.wedge_count());
  for (std::uint32_t w = 0; w < mesh.wedge_count(); ++w) {
    const double x = mesh.position(mesh.vertex_of(w)).x - 1000;
    if (std::abs(x) < 0.25) continue;
    const double grey = light_of_srgb(128.0 / 255);
    EXPECT_NEAR(values[3 * w], x > 0 ? 1 : grey, 0.02) << what << " at " << x;
    EXPECT_NEAR(values[3 * w + 1], x > 0 ? 0 : grey, 0.02) << what << " at " << x;
  }
}

TEST(ScanColors, are_on_the_surface_and_all_its_levels) {
  const auto made = surface_of_scan(ball(), coarse());
  ASSERT_TRUE(made) << made.error().line();
  expect_two_colors(made->model.meshes[0], "surface");
  LadderOptions options;
  options.ratios = {0.5, 0.25};
  const auto ladder = build_ladder(made->model, options);
  ASSERT_TRUE(ladder) << ladder.error().line();
  ASSERT_EQ(ladder->ladder.levels.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) expect_two_colors(ladder->ladder.model(i).meshes[0], "level");
}

TEST(ScanColors, a_splat_has_them_too) {
  PointCloud cloud = ball();
  cloud.normals.clear();
  ScanSurfaceOptions options = coarse();
  options.splat = true;
  const auto made = surface_of_scan(std::move(cloud), options);
  ASSERT_TRUE(made) << made.error().line();
  expect_two_colors(made->model.meshes[0], "splat");
}

TEST(ScanColors, neighbours_are_averaged_as_light) {
  PointCloud cloud = ball();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto c = static_cast<std::uint8_t>(i % 2 == 0 ? 255 : 0);
    cloud.colors[i] = {c, c, c, 255};
  }
  const auto made = surface_of_scan(std::move(cloud), coarse());
  ASSERT_TRUE(made) << made.error().line();
  const auto& values = std::get<std::vector<float>>(find_stream(made->model.meshes[0], Semantic::color)->values);
  double sum = 0;
  for (const float v : values) sum += static_cast<double>(v);
  EXPECT_NEAR(sum / static_cast<double>(values.size()), 0.5, 0.03);
}

TEST(ScanColors, black_alone_is_no_colour_and_no_colours_make_no_stream) {
  PointCloud black = ball();
  std::fill(black.colors.begin(), black.colors.end(), std::array<std::uint8_t, 4>{0, 0, 0, 255});
  const auto made = surface_of_scan(std::move(black), coarse());
  ASSERT_TRUE(made) << made.error().line();
  EXPECT_EQ(find_stream(made->model.meshes[0], Semantic::color), nullptr);
  EXPECT_TRUE(std::any_of(made->model.warnings.begin(), made->model.warnings.end(),
                          [](const std::string& w) { return w.find("are black") != std::string::npos; }));
  PointCloud plain = ball();
  plain.colors.clear();
  const auto other = surface_of_scan(std::move(plain), coarse());
  ASSERT_TRUE(other) << other.error().line();
  EXPECT_TRUE(other->model.meshes[0].attributes.empty());
}

}  // namespace
}  // namespace lodestone::chain
