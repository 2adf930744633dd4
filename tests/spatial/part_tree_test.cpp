#include "lodestone/spatial/part_tree.h"

#include <gtest/gtest.h>

#include "lodestone/base/random.h"
#include "lodestone/math/triangle.h"

namespace lodestone::spatial {
namespace {

struct Crowd {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> part_of_vertex;
};

// Random small parts of 1 to 40 triangles each, and one that reaches everywhere.
Crowd crowd(std::uint32_t parts) {
  Crowd out;
  std::uint64_t counter = 0;
  const auto random = [&] { return random_unit(5, counter++); };
  for (std::uint32_t p = 0; p < parts; ++p) {
    const Vec3d at{random(), random(), random()};
    const double size = p == 3 ? 1 : 0.03;
    const auto triangles = 1 + static_cast<std::size_t>(random() * 40);
    for (std::size_t t = 0; t < triangles; ++t) {
      const auto first = static_cast<std::uint32_t>(out.positions.size());
      for (int k = 0; k < 3; ++k) {
        out.positions.push_back(at + Vec3d{random(), random(), random()} * size);
        out.part_of_vertex.push_back(p);
      }
      out.triangles.push_back({first, first + 1, first + 2});
    }
  }
  return out;
}

TEST(PartTree, finds_what_trying_all_finds_while_parts_vanish) {
  const Crowd c = crowd(150);
  PartTree tree(c.positions, c.triangles, c.part_of_vertex, 150);
  std::vector<bool> gone(150, false);
  for (std::uint32_t round = 0; round < 150; ++round) {
    const auto own = static_cast<std::uint32_t>(random_bits(7, round) % 150);
    const Vec3d p{random_unit(8, 3 * round) * 3 - 1, random_unit(8, 3 * round + 1), random_unit(8, 3 * round + 2)};
    NearestPart best;
    for (const Triangle& t : c.triangles) {
      const std::uint32_t part = c.part_of_vertex[t[0]];
      if (gone[part] || part == own) continue;
      const double d = closest_point(p, c.positions[t[0]], c.positions[t[1]], c.positions[t[2]]).distance_sq;
      if (d < best.distance_sq) best = {part, t[0], d};
    }
    const NearestPart found = tree.nearest(p, [own](std::uint32_t q) { return q != own; });
    EXPECT_EQ(found.part, best.part);
    EXPECT_EQ(found.vertex, best.vertex);
    EXPECT_EQ(found.distance_sq, best.distance_sq);
    const auto none = tree.nearest(p, [](std::uint32_t) { return false; });
    EXPECT_EQ(none.part, kNone);
    if (best.part != kNone) {
      EXPECT_EQ(tree.nearest(
                        p, [own](std::uint32_t q) { return q != own; }, best.distance_sq * 0.99)
                    .part,
                kNone);
    }
    gone[round] = true;
    tree.remove(round);
  }
  EXPECT_EQ(tree.nearest({}, [](std::uint32_t) { return true; }).part, kNone) << "all are gone";
}

}  // namespace
}  // namespace lodestone::spatial
