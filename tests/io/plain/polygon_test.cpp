// Cutting polygons: large, concave, bent and crossing ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "lodestone/base/random.h"
#include "lodestone/io/plain/polygon.h"

namespace lodestone::io {
namespace {

using Corners = std::vector<Vec3d>;

constexpr double kTurn = 6.283185307179586;

Corners circle(std::size_t n) {
  Corners out;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = kTurn * static_cast<double>(i) / static_cast<double>(n);
    out.push_back({std::cos(t), std::sin(t), 0});
  }
  return out;
}

// Its radius jumps from corner to corner: half of the corners are deep notches.
Corners burst(std::size_t n) {
  Corners out = circle(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = out[i] * (0.2 + 0.8 * random_unit(2, i));
  return out;
}

Corners comb(std::size_t teeth) {
  Corners out{{0, -1, 0}, {static_cast<double>(teeth), -1, 0}};
  for (std::size_t i = teeth; i > 0; --i) {
    const auto x = static_cast<double>(i);
    for (const Vec3d& p : {Vec3d{x, 1, 0}, Vec3d{x - 0.4, 1, 0}, Vec3d{x - 0.45, 0, 0}, Vec3d{x - 0.95, 0, 0}}) {
      out.push_back(p);
    }
  }
  return out;
}

Corners spiral(std::size_t n) {
  Corners out, back;
  for (std::size_t i = 0; i < n / 2; ++i) {
    const double t = 0.5 + 20 * kTurn * static_cast<double>(i) / static_cast<double>(n / 2);
    out.push_back({t * std::cos(t), t * std::sin(t), 0});
    back.push_back({(t + 1.5) * std::cos(t), (t + 1.5) * std::sin(t), 0});
  }
  std::reverse(out.begin(), out.end());
  back.insert(back.end(), out.begin(), out.end());
  return back;
}

Corners figure_of_eight(std::size_t n) {
  Corners out;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = kTurn * (static_cast<double>(i) + 0.25) / static_cast<double>(n);
    out.push_back({1.5 * std::sin(t) + 0.1 * std::cos(t), std::sin(2 * t), 0});
  }
  return out;
}

Corners tangle(std::size_t n) {
  Corners out;
  for (std::size_t i = 0; i < n; ++i) out.push_back({random_unit(3, 2 * i), random_unit(3, 2 * i + 1), 0});
  return out;
}

double area_of(const Corners& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) sum += cross(p[i], p[(i + 1) % p.size()]).z / 2;
  return sum;
}

struct Cut {
  std::vector<CornerTriple> triples;
  double covered = 0;  // sum of the triangles' areas, all counted positive
  double area = 0;     // those that face down counted negative
  std::uint32_t most_at_corner = 0;
};

Cut cut(const Corners& p) {
  PolygonCutter cutter;
  const auto triples = cutter.cut(p);
  Cut out;
  out.triples.assign(triples.begin(), triples.end());
  std::vector<std::uint32_t> at(p.size(), 0);
  for (const CornerTriple& t : triples) {
    const Vec3d n = cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
    out.covered += length(n) / 2;
    out.area += n.z / 2;
    for (const std::uint32_t c : t) out.most_at_corner = std::max(out.most_at_corner, ++at[c]);
  }
  return out;
}

// n - 2 triangles; each side once, in its direction; each diagonal once in either.
void expect_whole(const Corners& p, const Cut& cut, const char* name) {
  EXPECT_EQ(cut.triples.size(), p.size() - 2) << name;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const CornerTriple& t : cut.triples) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(edges.emplace(t[k], t[(k + 1) % 3]).second) << name;
  }
  std::size_t open = 0;
  for (const auto& [a, b] : edges) {
    if (edges.contains({b, a})) continue;
    ++open;
    EXPECT_EQ(b, (a + 1) % p.size()) << name;
  }
  EXPECT_EQ(open, p.size()) << name;
}

TEST(Polygon, large_ones_are_covered_once) {
  const std::pair<const char*, Corners> shapes[] = {
      {"circle", circle(20000)}, {"burst", burst(20000)}, {"comb", comb(5000)}, {"spiral", spiral(20000)}};
  for (const auto& [name, corners] : shapes) {
    const Cut got = cut(corners);
    expect_whole(corners, got, name);
    EXPECT_NEAR(got.area, area_of(corners), 1e-9 * area_of(corners)) << name;
    EXPECT_NEAR(got.covered, area_of(corners), 1e-9 * area_of(corners)) << name << ": triangles lie on each other";
  }
}

TEST(Polygon, no_corner_collects_a_fan) {
  EXPECT_LE(cut(circle(20000)).most_at_corner, 64U);
  EXPECT_LE(cut(burst(20000)).most_at_corner, 64U);
}

// No corner lies well inside the circle through a triangle beside it: the smallest angles are as large as they can be.
TEST(Polygon, triangles_are_constrained_delaunay) {
  for (const Corners& p : {burst(500), spiral(500), Corners{{0, 0, 0}, {4, 0, 0}, {8, 0.1, 0}, {8, 1, 0}, {0, 1, 0}}}) {
    const Cut got = cut(p);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> apex;
    for (const CornerTriple& t : got.triples) {
      for (std::size_t k = 0; k < 3; ++k) apex[{t[k], t[(k + 1) % 3]}] = t[(k + 2) % 3];
    }
    for (const auto& [edge, r] : apex) {
      const std::uint32_t from = edge.first, to = edge.second;
      const auto other = apex.find({to, from});
      if (other == apex.end()) continue;
      const auto angle = [&, from, to](std::uint32_t at) {
        const Vec3d a = p[from] - p[at], b = p[to] - p[at];
        return std::acos(std::clamp(dot(normalized(a), normalized(b)), -1.0, 1.0));
      };
      const auto area = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        return cross(p[b] - p[a], p[c] - p[a]).z;
      };
      const std::uint32_t s = other->second;
      const bool convex = area(r, from, s) > 1e-9 && area(s, to, r) > 1e-9;
      EXPECT_TRUE(!convex || angle(r) + angle(s) < kTurn / 2 + 1e-6);
    }
  }
}

// Three laps, the inner one last, beside a square that they lie in: no corner is an ear for long.
Corners laps(std::size_t n) {
  Corners p{{-100, -100, 0}, {100, -100, 0}, {100, 100, 0}, {-100, 100, 0}, {-30, 0, 0}};
  for (std::size_t i = 0; i < n; ++i) {
    const double t = double(i) / double(n), a = 3.09 - 18.85 * t, r = 5 - 3 * t;
    p.push_back({r * std::cos(a), r * std::sin(a), 0});
  }
  return p;
}

TEST(Polygon, crossing_ones_still_give_a_result) {
  const std::pair<const char*, Corners> shapes[] = {{"eight", figure_of_eight(4000)},
                                                    {"tangle", tangle(1500)},
                                                    {"laps", laps(300'000)},
                                                    {"one place", Corners(7, Vec3d{1, 2, 3})}};
  for (const auto& [name, corners] : shapes) {
    const Cut got = cut(corners);
    expect_whole(corners, got, name);
    EXPECT_NEAR(got.area, area_of(corners), 1e-9) << name;
  }
}

TEST(Polygon, holes_on_bridges_stay_open) {
  // A square of side 8 with a hole of side 4, reached by a bridge that is walked both ways.
  const Corners p{{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}, {-4, -4, 0},
                  {-2, -2, 0}, {-2, 2, 0}, {2, 2, 0}, {2, -2, 0}, {-2, -2, 0}};
  const Cut got = cut(p);
  EXPECT_NEAR(got.area, 48, 1e-9);
  EXPECT_NEAR(got.covered, 48, 1e-9);
}

TEST(Polygon, bent_ones_keep_their_sides) {
  Corners p = burst(300);
  for (Vec3d& q : p) q.z = 0.4 * q.x * q.x - 0.3 * q.y;
  expect_whole(p, cut(p), "bent");
}

TEST(Polygon, a_cutter_may_be_used_again) {
  PolygonCutter cutter;
  for (const Corners& p : {burst(300), circle(7), comb(30), circle(5)}) {
    const auto again = cutter.cut(p);
    EXPECT_EQ(std::vector<CornerTriple>(again.begin(), again.end()), cut(p).triples);
  }
}

}  // namespace
}  // namespace lodestone::io
