// What a level is like apart from its distance to the original:
//   level_quality ORIGINAL LEVEL
// prints one line of JSON. Of the level: folds (manifold edges whose two triangles' normals are over 170 degrees
// apart), the mean over triangles of the smallest angle (degrees; 0 without area), crossings (pairs of triangles that
// meet). Of both: how far their borders are apart, in shares of the original's diagonal, and how many edges these have.
// Crossings are CGAL's boxes and exact do_intersect over a soup, as CGAL 5.5's own self_intersections takes no
// non-manifold one: pairs that share a vertex are left out (so are neighbours that fold over each other: see folds),
// and so are triangles without area.
#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "lodestone/io/read.h"
#include "lodestone/math/triangle.h"
#include "lodestone/spatial/surface.h"

namespace {

using namespace lodestone;
using spatial::Surface;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

constexpr double kFold = 170;   // degrees
constexpr double kStep = 1e-4;  // of the diagonal: between samples along a border

struct Side {
  std::uint32_t a, b;  // a < b
  std::uint32_t triangle;
  bool turned;  // the triangle runs from b to a
};

// All triangles' sides, those of one edge next to each other. A side between a vertex and itself is none.
std::vector<Side> sides_of(const Surface& surface) {
  std::vector<Side> sides;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = surface.triangles[t][k], to = surface.triangles[t][(k + 1) % 3];
      if (from != to) sides.push_back({std::min(from, to), std::max(from, to), t, from > to});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return std::tie(x.a, x.b, x.triangle) < std::tie(y.a, y.b, y.triangle);
  });
  return sides;
}

// Calls with the first side of each edge that has `count` of them.
template <class Call>
void for_edges(const std::vector<Side>& sides, std::ptrdiff_t count, Call call) {
  for (auto at = sides.begin(); at != sides.end();) {
    const auto end = std::find_if(at, sides.end(), [&](const Side& s) { return s.a != at->a || s.b != at->b; });
    if (end - at == count) call(&*at);
    at = end;
  }
}

// Degrees; nothing if one has no length.
std::optional<double> angle(Vec3d a, Vec3d b) {
  if (dot(a, a) == 0 || dot(b, b) == 0) return std::nullopt;
  a = normalized(a), b = normalized(b);
  return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

// Neighbours that disagree about which side is out are compared as if they agreed.
std::size_t folds(const Surface& surface, const std::vector<Side>& sides) {
  std::size_t count = 0;
  const auto normal = [&](const Side& s) {
    const auto [a, b, c] = surface.corners(s.triangle);
    return scaled_normal(a, b, c) * (s.turned ? -1.0 : 1.0);
  };
  for_edges(sides, 2, [&](const Side* s) {
    const auto between = angle(normal(s[0]), -normal(s[1]));
    if (between && *between > kFold) ++count;
  });
  return count;
}

double mean_smallest_angle(const Surface& surface) {
  double sum = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto p = surface.corners(t);
    double smallest = 180;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d& at = p[k];
      smallest = std::min(smallest, angle(p[(k + 1) % 3] - at, p[(k + 2) % 3] - at).value_or(0));
    }
    sum += smallest;
  }
  return sum / static_cast<double>(surface.triangles.size());
}

Kernel::Point_3 point(const Vec3d& p) { return {p.x, p.y, p.z}; }

std::size_t crossings(const Surface& surface) {
  using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;
  std::vector<Kernel::Triangle_3> shapes;
  std::vector<Box> boxes;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    shapes.emplace_back(point(a), point(b), point(c));
    if (!shapes.back().is_degenerate()) boxes.emplace_back(shapes.back().bbox(), t);
  }
  const auto neighbours = [&](std::uint32_t s, std::uint32_t t) {
    const Triangle &a = surface.triangles[s], &b = surface.triangles[t];
    return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
  };
  std::size_t count = 0;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& x, const Box& y) {
    if (!neighbours(x.info(), y.info()) && CGAL::do_intersect(shapes[x.info()], shapes[y.info()])) ++count;
  });
  return count;
}

using Segments = std::vector<Kernel::Segment_3>;

Segments border_of(const Surface& surface, const std::vector<Side>& sides) {
  Segments border;
  for_edges(sides, 1, [&](const Side* s) {
    border.emplace_back(point(surface.positions[s->a]), point(surface.positions[s->b]));
  });
  return border;
}

struct Apart {
  double mean = 0, max = 0;
};

// From all places along one border to the nearest of the other; the mean is over length.
Apart one_sided(const Segments& from, const Segments& to, double step) {
  using Primitive = CGAL::AABB_segment_primitive<Kernel, Segments::const_iterator>;
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree(to.begin(), to.end());
  tree.accelerate_distance_queries();
  Apart apart;
  double total = 0;
  for (const Kernel::Segment_3& edge : from) {
    const double size = std::sqrt(edge.squared_length());
    const int parts = std::max(1, static_cast<int>(std::ceil(size / step)));
    for (int i = 0; i <= parts; ++i) {
      const double distance = std::sqrt(tree.squared_distance(edge.source() + edge.to_vector() * i / parts));
      apart.max = std::max(apart.max, distance);
      apart.mean += distance * size / parts * (i == 0 || i == parts ? 0.5 : 1);
    }
    total += size;
  }
  apart.mean /= total;
  return apart;
}

// Nothing if one of them has no border.
std::optional<Apart> two_sided(const Segments& a, const Segments& b, double diagonal) {
  if (a.empty() || b.empty()) return std::nullopt;
  const Apart there = one_sided(a, b, kStep * diagonal), back = one_sided(b, a, kStep * diagonal);
  return Apart{(there.mean + back.mean) / 2 / diagonal, std::max(there.max, back.max) / diagonal};
}

Result<Surface> read(const char* path) {
  const Result<Model> model = io::read_model(path);
  if (!model) return tl::unexpected(model.error());
  return spatial::flatten(*model);
}

std::string number(const std::optional<double>& value) {
  char text[32] = "null";
  if (value) std::snprintf(text, sizeof text, "%.6g", *value);
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: level_quality ORIGINAL LEVEL\n", stderr);
    return 2;
  }
  const Result<Surface> original = read(argv[1]), level = read(argv[2]);
  if (!original || !level) {
    std::fprintf(stderr, "level_quality: %s\n", (original ? level : original).error().line().c_str());
    return 1;
  }
  const std::vector<Side> sides = sides_of(*level);
  const Segments border = border_of(*level, sides), original_border = border_of(*original, sides_of(*original));
  const auto apart = two_sided(original_border, border, original->bounds.diagonal());
  std::printf(
      "{\"folds\": %zu, \"mean_smallest_angle\": %.6g, \"crossings\": %zu, \"border_mean\": %s, \"border_max\": %s, "
      "\"border_edges\": [%zu, %zu]}\n",
      folds(*level, sides), mean_smallest_angle(*level), crossings(*level),
      number(apart ? std::optional(apart->mean) : std::nullopt).c_str(),
      number(apart ? std::optional(apart->max) : std::nullopt).c_str(), original_border.size(), border.size());
  return 0;
}
