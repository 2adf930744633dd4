// Where the creases of a surface run through the cubes of a grid.
//
// Problem: sharp_surface.cpp wants one point for each cube that lies on a crease of the source, or at a corner of it.
// Method: creases are not estimated from the volume; the source's edges are cut by the lattice.
// 1. creases_of(): edges whose two triangles have normals that differ by more than an angle, found
//    by sorting all sides.
// 2. corners_of(): vertices where a crease ends, where several meet, or where one turns by more than 45 degrees.
// 3. Lattice, cut_into_runs(): creases cut at the faces of cubes; a run is what lies within one cube.
// 4. middle_of(): the point of a cube's runs that is nearest to their mean, so that it lies on a crease.
// 5. crease_points(): one point a cube, by cube; a corner goes before all others.
// Invariants: sorts are stable or have a total order, and all runs on one thread. Open edges are no creases; triangles
// of an edge that has more than two are taken in pairs. Cost: O(n log n), n being sides and runs.
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "lodestone/voxel/creases_detail.h"

namespace lodestone::voxel::detail {

namespace {

struct Crease {
  std::uint32_t a = 0, b = 0;  // vertices, a < b
};

Vec3d unit_normal(const spatial::Surface& surface, std::size_t triangle) {
  const auto [a, b, c] = surface.corners(triangle);
  const Vec3d n = cross(b - a, c - a);
  const double l = length(n);
  return l > 0 ? n / l : Vec3d{};
}

std::vector<Crease> creases_of(const spatial::Surface& surface, double cosine) {
  struct HalfEdge {
    std::uint32_t a, b, triangle;
  };
  std::vector<HalfEdge> sides;
  sides.reserve(surface.triangles.size() * 3);
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle& v = surface.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = v[k], b = v[(k + 1) % 3];
      if (a != b) sides.push_back({std::min(a, b), std::max(a, b), t});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const HalfEdge& x, const HalfEdge& y) {
    return std::tie(x.a, x.b, x.triangle) < std::tie(y.a, y.b, y.triangle);
  });
  std::vector<Crease> out;
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const bool pair = sides[i].a == sides[i + 1].a && sides[i].b == sides[i + 1].b;
    if (!pair) continue;
    const Vec3d m = unit_normal(surface, sides[i].triangle), n = unit_normal(surface, sides[i + 1].triangle);
    if (dot(m, m) > 0 && dot(n, n) > 0 && dot(m, n) < cosine) out.push_back({sides[i].a, sides[i].b});
    ++i;
  }
  return out;
}

// Vertices where a crease ends, where several meet, or where one turns by more than 45 degrees.
std::vector<std::uint32_t> corners_of(const spatial::Surface& surface, const std::vector<Crease>& creases) {
  std::vector<std::array<std::uint32_t, 2>> ends;  // vertex, the other end
  for (const Crease& c : creases) {
    ends.push_back({c.a, c.b});
    ends.push_back({c.b, c.a});
  }
  std::sort(ends.begin(), ends.end());
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < ends.size();) {
    std::size_t end = i;
    while (end < ends.size() && ends[end][0] == ends[i][0]) ++end;
    const Vec3d at = surface.positions[ends[i][0]];
    bool corner = end - i != 2;
    if (!corner) {
      const Vec3d p = surface.positions[ends[i][1]] - at, q = surface.positions[ends[i + 1][1]] - at;
      corner = dot(p, q) > -0.70711 * length(p) * length(q);
    }
    if (corner) corners.push_back(ends[i][0]);
    i = end;
  }
  return corners;
}

// Coordinates in which cubes have sides of 1: whole numbers are the centres of voxels, which are corners of cubes.
class Lattice {
 public:
  explicit Lattice(const VoxelGrid& grid) : grid_(grid) {
    for (std::size_t k = 0; k < 3; ++k) cubes_[k] = grid.size[k] + 1;
  }
  Vec3d to(Vec3d p) const {
    Vec3d out;
    for (std::size_t k = 0; k < 3; ++k) out[k] = (p[k] - grid_.origin[k]) / grid_.spacing[k] + 0.5;
    return out;
  }
  bool cube_of(Vec3d at, std::uint64_t& cube) const {
    std::array<std::uint64_t, 3> c{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(at[k] >= 0 && at[k] < cubes_[k])) return false;
      c[k] = static_cast<std::uint64_t>(at[k]);
    }
    cube = (c[2] * (std::uint64_t{grid_.size[1]} + 2) + c[1]) * (std::uint64_t{grid_.size[0]} + 2) + c[0];
    return true;
  }

 private:
  const VoxelGrid& grid_;
  std::array<double, 3> cubes_{};
};

// A piece of a crease within one cube.
struct Run {
  std::uint64_t cube;
  Vec3d from, to;
};

// Cuts a segment where it crosses whole numbers.
void cut_into_runs(const Lattice& lattice, Vec3d a, Vec3d b, std::vector<double>& cuts, std::vector<Run>& runs) {
  const Vec3d p = lattice.to(a), q = lattice.to(b);
  cuts.assign({0, 1});
  for (std::size_t k = 0; k < 3; ++k) {
    const double low = std::min(p[k], q[k]), high = std::max(p[k], q[k]);
    if (!(high - low < 70'000)) return;  // not in any grid
    for (double at = std::ceil(low); at < high; ++at) cuts.push_back((at - p[k]) / (q[k] - p[k]));
  }
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double from = std::clamp(cuts[i], 0.0, 1.0), to = std::clamp(cuts[i + 1], 0.0, 1.0);
    std::uint64_t cube = 0;
    if (!(to > from) || !lattice.cube_of(p + (q - p) * ((from + to) / 2), cube)) continue;
    runs.push_back({cube, a + (b - a) * from, a + (b - a) * to});
  }
}

// The point of all runs that is nearest to their middle.
Vec3d middle_of(const Run* begin, const Run* end) {
  Vec3d sum;
  double weight = 0;
  for (const Run* r = begin; r != end; ++r) {
    const double l = length(r->to - r->from);
    sum += (r->from + r->to) * (l / 2);
    weight += l;
  }
  const Vec3d middle = weight > 0 ? sum / weight : begin->from;
  Vec3d best = begin->from;
  double least = -1;
  for (const Run* r = begin; r != end; ++r) {
    const Vec3d along = r->to - r->from;
    const double square = dot(along, along);
    const double t = square > 0 ? std::clamp(dot(middle - r->from, along) / square, 0.0, 1.0) : 0;
    const Vec3d at = r->from + along * t;
    const double d = dot(at - middle, at - middle);
    if (least < 0 || d < least) {
      least = d;
      best = at;
    }
  }
  return best;
}

}  // namespace

std::vector<CreasePoint> crease_points(const spatial::Surface& surface, const VoxelGrid& grid, double cosine) {
  const std::vector<Crease> creases = creases_of(surface, cosine);
  const Lattice lattice(grid);
  std::vector<Run> runs;
  std::vector<double> cuts;
  for (const Crease& c : creases) {
    cut_into_runs(lattice, surface.positions[c.a], surface.positions[c.b], cuts, runs);
  }
  std::stable_sort(runs.begin(), runs.end(), [](const Run& x, const Run& y) { return x.cube < y.cube; });
  std::vector<CreasePoint> out;
  for (const std::uint32_t v : corners_of(surface, creases)) {
    std::uint64_t cube = 0;
    if (lattice.cube_of(lattice.to(surface.positions[v]), cube)) out.push_back({cube, surface.positions[v], true});
  }
  for (std::size_t i = 0; i < runs.size();) {
    std::size_t end = i;
    while (end < runs.size() && runs[end].cube == runs[i].cube) ++end;
    out.push_back({runs[i].cube, middle_of(runs.data() + i, runs.data() + end), false});
    i = end;
  }
  // One a cube: a corner, the first of several, before all others.
  std::stable_sort(out.begin(), out.end(), [](const CreasePoint& x, const CreasePoint& y) {
    return x.cube != y.cube ? x.cube < y.cube : x.corner && !y.corner;
  });
  out.erase(
      std::unique(out.begin(), out.end(), [](const CreasePoint& x, const CreasePoint& y) { return x.cube == y.cube; }),
      out.end());
  return out;
}

}  // namespace lodestone::voxel::detail
