#include "lodestone/measure/graph_bound_detail.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "support/shapes.h"

namespace lodestone::measure::detail {
namespace {

// The square [0, 1]^2 under a piece at z = 0, with a margin around it.
spatial::Surface sheet(int cells, const std::function<double(double, double)>& height) {
  Mesh mesh = test::grid(cells);
  for (Vec3f& p : mesh.positions) {
    p = {2 * p.x - 0.5F, 2 * p.y - 0.5F, 0};
    p.z = static_cast<float>(height(p.x, p.y));
  }
  return *spatial::flatten(make_model(mesh));
}

constexpr std::array<Vec3d, 3> kPiece{Vec3d{0.1, 0.2, 0}, Vec3d{0.9, 0.3, 0}, Vec3d{0.4, 0.8, 0}};
constexpr double kAny = std::numeric_limits<double>::infinity();

std::uint32_t below_the_middle(const spatial::Surface& surface) {
  std::uint32_t nearest = 0;
  double least = kAny;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    const Vec3d d = (a + b + c) / 3.0 - Vec3d{0.45, 0.45, 0};
    if (d.x * d.x + d.y * d.y >= least) continue;
    least = d.x * d.x + d.y * d.y;
    nearest = t;
  }
  return nearest;
}

TEST(GraphBound, is_the_greatest_height) {
  for (const int cells : {1, 2, 3, 5, 8}) {
    const spatial::Surface flat = sheet(cells, [](double, double) { return 0.3; });
    const Neighbors neighbors = spatial::triangle_neighbors(flat);
    const std::uint32_t start[] = {below_the_middle(flat)};
    EXPECT_NEAR(GraphBound(flat, neighbors)(kPiece, start, kAny), 0.3, 1e-6) << cells;
  }
  // A plane that rises with x: highest over the corner at x = 0.9.
  const spatial::Surface slope = sheet(4, [](double x, double) { return 0.5 * x; });
  const std::uint32_t start[] = {below_the_middle(slope)};
  EXPECT_NEAR(GraphBound(slope, spatial::triangle_neighbors(slope))(kPiece, start, kAny), 0.45, 1e-6);
  // From below as from above.
  const auto [a, b, c] = kPiece;
  EXPECT_NEAR(GraphBound(slope, spatial::triangle_neighbors(slope))({a, c, b}, start, kAny), 0.45, 1e-6);
}

TEST(GraphBound, says_nothing_where_the_surface_has_a_hole) {
  spatial::Surface holed = sheet(8, [](double, double) { return 0.1; });
  const std::uint32_t gone = below_the_middle(holed), other = gone == 0 ? 1 : 0;
  const std::uint32_t near[] = {spatial::triangle_neighbors(holed)[gone][0]};
  ASSERT_LT(GraphBound(holed, spatial::triangle_neighbors(holed))(kPiece, near, kAny), kAny);
  holed.triangles[gone] = holed.triangles[other];
  EXPECT_EQ(GraphBound(holed, spatial::triangle_neighbors(holed))(kPiece, near, kAny), kAny);
}

TEST(GraphBound, says_nothing_where_the_surface_folds_or_stands_up) {
  // A Z in section: it goes on over the middle, comes back below it, and goes on.
  spatial::Surface folded = sheet(16, [](double, double) { return 0.0; });
  for (Vec3d& p : folded.positions) {
    const double x = p.x;
    if (x > 0.3 && x < 0.7) p = {1.0 - x, p.y, 0.2 * (x - 0.3)};
    if (x >= 0.7) p.z = 0.08;
  }
  std::size_t nothing = 0, wrong = 0;
  for (std::uint32_t t = 0; t < folded.triangles.size(); ++t) {
    const std::uint32_t start[] = {t};
    const double bound = GraphBound(folded, spatial::triangle_neighbors(folded))(kPiece, start, kAny);
    nothing += bound == kAny ? 1 : 0;
    wrong += bound < 0.07 ? 1 : 0;
  }
  EXPECT_EQ(nothing, folded.triangles.size());
  EXPECT_EQ(wrong, 0U);
}

// Two large triangles that lie on each other left of x = 0.5, where they are joined. Both are wound the same way, so
// that both seem to face alike; and yet the piece is bare right of that.
TEST(GraphBound, says_nothing_where_a_fold_is_wound_as_if_it_were_none) {
  const Mesh mesh =
      test::make_mesh({{0.5F, -5, 0}, {0.5F, 5, 0}, {-5, 0, 0}, {-5, 0.1F, 0.01F}}, {{0, 1, 2}, {0, 1, 3}});
  const auto surface = spatial::flatten(make_model(mesh));
  ASSERT_TRUE(surface);
  const Neighbors neighbors = spatial::triangle_neighbors(*surface);
  for (const std::uint32_t t : {0U, 1U}) {
    const std::uint32_t start[] = {t};
    EXPECT_EQ(GraphBound(*surface, neighbors)(kPiece, start, kAny), kAny) << t;
  }
}

TEST(GraphBound, degenerate_pieces_and_distant_patches) {
  const spatial::Surface flat = sheet(4, [](double, double) { return 0.3; });
  const Neighbors neighbors = spatial::triangle_neighbors(flat);
  const std::uint32_t start[] = {below_the_middle(flat)};
  GraphBound bound(flat, neighbors);
  EXPECT_EQ(bound({kPiece[0], kPiece[0], kPiece[1]}, start, kAny), kAny);
  EXPECT_EQ(bound({kPiece[0] + Vec3d{9, 0, 0}, kPiece[1] + Vec3d{9, 0, 0}, kPiece[2] + Vec3d{9, 0, 0}}, start, kAny),
            kAny);
  EXPECT_GT(bound(kPiece, start, 0.1), 0.1);
}

}  // namespace
}  // namespace lodestone::measure::detail
