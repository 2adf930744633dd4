#include "lodestone/measure/image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestone/base/random.h"
#include "lodestone/measure/image_figures_detail.h"
#include "support/shapes.h"

namespace lodestone::measure {
namespace {

ImageDeviation deviation(const Mesh& a, const Mesh& b, ImageOptions options = {}, int threads = 0) {
  const Task task = Task::root({}, threads);
  const auto reference = ImageReference::create(make_model(a), options, task);
  EXPECT_TRUE(reference);
  return *reference->deviation_of(make_model(b), task);
}

TEST(Image, nothing_differs_from_itself) {
  const ImageDeviation d = deviation(test::torus(20), test::torus(20), {6, 128});
  EXPECT_EQ(d.silhouette_mean, 0);
  EXPECT_EQ(d.silhouette_max, 0);
  EXPECT_EQ(d.screen_max_px, 0);
  EXPECT_EQ(d.shading_psnr, 100);
  EXPECT_NEAR(d.shading_ssim, 1, 1e-5);
  EXPECT_FALSE(d.has_color);
}

// A sphere of nine tenths of the radius: a silhouette's area differs by 19 %, its outline by a tenth of the radius,
// which is half the picture over the root of 3 (the sphere around the box fits the picture).
TEST(Image, a_smaller_sphere) {
  Mesh small = test::sphere(48);
  for (Vec3f& p : small.positions) p = p * 0.9F;
  const ImageDeviation d = deviation(test::sphere(48), small, {20, 512});
  EXPECT_EQ(d.views, 20);
  EXPECT_NEAR(d.silhouette_mean, 0.19, 0.005);
  EXPECT_NEAR(d.silhouette_max, 0.19, 0.01);
  EXPECT_NEAR(d.screen_max_px, 0.1 * 256 / std::sqrt(3.0), 2);
  EXPECT_LT(d.shading_psnr, 30);
  EXPECT_LT(d.shading_ssim, 0.99);
}

TEST(Image, coarser_is_worse) {
  ImageDeviation last = deviation(test::sphere(64), test::sphere(48), {8, 256});
  for (const int rings : {24, 12, 6}) {
    const ImageDeviation d = deviation(test::sphere(64), test::sphere(rings), {8, 256});
    EXPECT_GT(d.silhouette_mean, last.silhouette_mean) << rings;
    EXPECT_LT(d.shading_psnr, last.shading_psnr) << rings;
    EXPECT_LT(d.shading_ssim, last.shading_ssim) << rings;
    last = d;
  }
}

TEST(Image, a_level_without_triangles_differs_wholly) {
  const auto reference = ImageReference::create(make_model(test::cube()), {4, 64});
  ASSERT_TRUE(reference);
  const auto d = reference->deviation_of(Model{});
  ASSERT_TRUE(d) << d.error().line();
  EXPECT_EQ(d->silhouette_mean, 1);
}

TEST(Image, same_figures_for_any_thread_count) {
  const ImageDeviation one = deviation(test::torus(20), test::torus(7), {4, 200}, 1),
                       seven = deviation(test::torus(20), test::torus(7), {4, 200}, 7);
  EXPECT_EQ(one.silhouette_mean, seven.silhouette_mean);
  EXPECT_EQ(one.shading_psnr, seven.shading_psnr);
  EXPECT_EQ(one.shading_ssim, seven.shading_ssim);
}

TEST(Image, bad_arguments) {
  EXPECT_EQ(ImageReference::create(make_model(test::cube()), {5, 100}).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(ImageReference::create(make_model(test::cube()), {4, 2}).error().code, ErrorCode::bad_argument);
}

TEST(ImageFigures, distances_are_those_of_a_search) {
  constexpr std::uint32_t width = 23, height = 17;
  for (const double share : {0.0, 0.005, 0.1, 0.9}) {
    std::vector<std::uint8_t> set(width * height);
    for (std::size_t i = 0; i < set.size(); ++i) set[i] = random_unit(7, i) < share ? 1 : 0;
    const std::vector<float> found = detail::distances_to(set, width, height);
    for (int y = 0; y < int(height); ++y) {
      for (int x = 0; x < int(width); ++x) {
        double nearest = std::numeric_limits<double>::infinity();
        for (int v = 0; v < int(height); ++v) {
          for (int u = 0; u < int(width); ++u) {
            if (set[static_cast<std::size_t>(v * int(width) + u)] != 0)
              nearest = std::min(nearest, std::hypot(u - x, v - y));
          }
        }
        const double d = found[static_cast<std::size_t>(y * int(width) + x)];
        if (std::isinf(nearest)) {
          EXPECT_TRUE(std::isinf(d));
        } else {
          EXPECT_NEAR(d, nearest, 1e-4) << share << " " << x << " " << y;
        }
      }
    }
  }
}

}  // namespace
}  // namespace lodestone::measure
