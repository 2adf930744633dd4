// Triangles of cubes in which the corners alone don't say how the surface passes through.
//
// Problem: where inside corners of a face, or of the cube, lie opposite, the table of cube_cases.cpp always parts them;
// the trilinear interpolant of the values may join them. Method: faces by the asymptotic decider (G. Nielson and
// B. Hamann, 1991 [nielson-hamann-1991]); a tube between two rings by the value at the interpolant's saddles
// (E. Chernyaev, Marching Cubes 33, 1995 [chernyaev-1995]).
// 1. polynomial(), saddles(): the interpolant of a cube, and the points inside where its gradient is 0.
// 2. SliceMaker: a ring becomes a fan (add_disk()), two rings become a tube (add_tube()).
// 3. is_ambiguous(): the cases that may differ from the table.
// 4. trilinear_cube(): walks around each face, joins opposite inside corners where joins_inside() says so, and follows
//    the lines to rings. Of two rings it asks whether a saddle joins what they part.
// 5. make_trilinear_triangles(): all cut cubes, the unambiguous ones by the table.
// Invariants: two cubes beside a face compute the same products and so cut it alike; no triangle has a side in a face
// but on the lines there. Slices are worked on apart, their own vertices numbered from kOwn, and joined in order: the
// same bytes for any thread count. With three rings or more each is taken for a piece of its own. Cost: O(cut cubes).
#include "lodestone/voxel/trilinear_cubes_detail.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lodestone/base/parallel.h"
#include "lodestone/voxel/cube_cases_detail.h"
#include "lodestone/voxel/row_numbers_detail.h"

namespace lodestone::voxel::detail {

namespace {

// The corners of a face, counter-clockwise seen from outside the cube.
std::array<unsigned, 4> face_corners(unsigned axis, bool high) {
  const unsigned u = 1U << ((axis + 1) % 3), v = 1U << ((axis + 2) % 3), base = high ? 1U << axis : 0U;
  if (high) return {base, base | u, base | u | v, base | v};
  return {base, base | v, base | u | v, base | u};
}

std::uint8_t edge_between(unsigned a, unsigned b) {
  const unsigned axis = (a ^ b) >> 1, low = a & b;
  for (std::uint8_t e = 0; e < 12; ++e) {
    if (e / 4U == axis && kEdgeCorner[e] == low) return e;
  }
  return 0;
}

bool opposite_inside(unsigned corners, const std::array<unsigned, 4>& c) {
  const auto in = [&](std::size_t k) { return (corners >> c[k] & 1) != 0; };
  return in(0) == in(2) && in(1) == in(3) && in(0) != in(1);
}

// Whether the bilinear interpolant of a face joins its opposite inside corners. Both cubes beside it compute the same
// products.
bool joins_inside(const CornerValues& v, unsigned corners, const std::array<unsigned, 4>& c) {
  const double even = v[c[0]] * v[c[2]], odd = v[c[1]] * v[c[3]];
  return (corners >> c[0] & 1) != 0 ? even > odd : odd > even;
}

// Which corners are joined, all being apart at first.
struct Pieces {
  std::array<unsigned, 8> of;
  Pieces() { std::iota(of.begin(), of.end(), 0U); }
  void join(unsigned a, unsigned b) {
    const unsigned from = of[a], to = of[b];
    for (unsigned& p : of) p = p == from ? to : p;
  }
  unsigned count(unsigned corners, bool inside) const {
    unsigned seen = 0, n = 0;
    for (unsigned k = 0; k < 8; ++k) {
      if (((corners >> k & 1) != 0) != inside || (seen >> of[k] & 1) != 0) continue;
      seen |= 1U << of[k];
      ++n;
    }
    return n;
  }
};

// F(x, y, z) = f[0] + f[1] x + f[2] y + f[3] xy + f[4] z + f[5] xz + f[6] yz + f[7] xyz.
std::array<double, 8> polynomial(const CornerValues& v) {
  std::array<double, 8> f{};
  for (unsigned k = 0; k < 8; ++k) {
    for (unsigned c = 0; c < 8; ++c) {
      if ((c & k) != c) continue;
      const int missing = __builtin_popcount(k & ~c);
      f[k] += missing % 2 == 0 ? v[c] : -v[c];
    }
  }
  return f;
}

double at(const std::array<double, 8>& f, Vec3d p) {
  return f[0] + f[1] * p.x + f[2] * p.y + f[3] * p.x * p.y + f[4] * p.z + f[5] * p.x * p.z + f[6] * p.y * p.z +
         f[7] * p.x * p.y * p.z;
}

// Points inside the cube where the gradient is 0: at most two.
std::vector<Vec3d> saddles(const std::array<double, 8>& f) {
  std::vector<Vec3d> out;
  const double b = f[1], c = f[2], d = f[4], e = f[3], g = f[6], h = f[7], i = f[5];
  const auto keep = [&](Vec3d p) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(p[k] > 0 && p[k] < 1)) return;
    }
    out.push_back(p);
  };
  if (h == 0) {
    // e y + i z = -b, e x + g z = -c, i x + g y = -d.
    const double twice = 2 * e * g * i;
    if (twice != 0) {
      const double x = (g * b - i * c - e * d) * g / twice;
      const double y = (i * c - g * b - e * d) * i / twice;
      const double z = (e * d - g * b - i * c) * e / twice;
      keep({x, y, z});
    }
    return out;
  }
  // Moved by (g, i, e) / h only the product of all three and linear terms are left.
  const double a = b - e * i / h, bb = c - e * g / h, cc = d - i * g / h;
  const double x2 = -bb * cc / (h * a), y2 = -a * cc / (h * bb), z2 = -a * bb / (h * cc);
  if (!(x2 > 0 && y2 > 0 && z2 > 0)) return out;
  const double x = std::sqrt(x2), y = std::sqrt(y2), z = std::sqrt(z2);
  // yz = -a / h, xz = -bb / h, xy = -cc / h: the signs of y and z follow from that of x.
  const double sign_y = -cc / h > 0 ? 1 : -1, sign_z = -bb / h > 0 ? 1 : -1;
  for (const double s : {1.0, -1.0}) keep({s * x - g / h, s * sign_y * y - i / h, s * sign_z * z - e / h});
  return out;
}

unsigned corners_of(const CornerValues& v) {
  unsigned corners = 0;
  for (unsigned k = 0; k < 8; ++k) corners |= v[k] > 0 ? 1U << k : 0U;
  return corners;
}

// A slice's triangles, and its own vertices, whose numbers begin after kOwn.
constexpr std::uint32_t kOwn = std::uint32_t{1} << 31;
struct Part {
  std::vector<Triangle> triangles;
  std::vector<Vec3f> vertices;
};

class SliceMaker {
 public:
  SliceMaker(const Mesh& mesh, Part& part) : mesh_(mesh), part_(part) {}

  void add_disk(const std::vector<std::uint32_t>& ring) {
    if (ring.size() == 3) {
      part_.triangles.push_back({ring[0], ring[1], ring[2]});
      return;
    }
    // No side in a face of the cube, whatever the ring: a fan around its middle.
    Vec3d sum;
    for (const std::uint32_t v : ring) sum += point(v);
    const std::uint32_t centre = own(sum / static_cast<double>(ring.size()));
    for (std::size_t k = 0; k < ring.size(); ++k) {
      part_.triangles.push_back({ring[k], ring[(k + 1) % ring.size()], centre});
    }
  }

  // A tube between two rings, which run the other way round each other: with a ring of its own in the middle, so that
  // no side lies in a face.
  void add_tube(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
    const std::size_t n = a.size(), m = b.size();
    std::size_t start = 0;
    double least = -1;
    for (std::size_t k = 0; k < m; ++k) {
      const double d = length(point(b[k]) - point(a[0]));
      if (least < 0 || d < least) {
        least = d;
        start = k;
      }
    }
    const auto other = [&](std::size_t step) { return b[(start + m - step % m) % m]; };  // backwards
    std::vector<std::uint32_t> middle;
    for (std::size_t k = 0; k < n; ++k) middle.push_back(own((point(a[k]) + point(other(k * m / n))) / 2));
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t next = (k + 1) % n;
      part_.triangles.push_back({a[k], a[next], middle[k]});
      part_.triangles.push_back({a[next], middle[next], middle[k]});
    }
    std::size_t i = 0, j = 0;
    while (i < n || j < m) {
      // Whichever is behind goes on.
      const bool along_middle = j == m || (i < n && i * m <= j * n);
      if (along_middle) {
        part_.triangles.push_back({middle[i % n], middle[(i + 1) % n], other(j)});
        ++i;
      } else {
        part_.triangles.push_back({other(j), middle[i % n], other(j + 1)});
        ++j;
      }
    }
  }

 private:
  Vec3d point(std::uint32_t v) const { return to_double(v < kOwn ? mesh_.positions[v] : part_.vertices[v - kOwn]); }
  std::uint32_t own(Vec3d p) {
    part_.vertices.push_back(to_float(p));
    return kOwn + static_cast<std::uint32_t>(part_.vertices.size() - 1);
  }
  const Mesh& mesh_;
  Part& part_;
};

}  // namespace

bool is_ambiguous(unsigned corners) {
  for (unsigned axis = 0; axis < 3; ++axis) {
    for (const bool high : {false, true}) {
      if (opposite_inside(corners, face_corners(axis, high))) return true;
    }
  }
  for (const unsigned pair : {0x81U, 0x42U, 0x24U, 0x18U}) {
    if (corners == pair || corners == (pair ^ 255U)) return true;
  }
  return false;
}

TrilinearCube trilinear_cube(const CornerValues& values) {
  const unsigned corners = corners_of(values);
  const auto in = [&](unsigned k) { return (corners >> k & 1) != 0; };
  std::array<int, 12> next;
  next.fill(-1);
  Pieces pieces;
  for (unsigned axis = 0; axis < 3; ++axis) {
    for (const bool high : {false, true}) {
      const std::array<unsigned, 4> c = face_corners(axis, high);
      const bool opposite = opposite_inside(corners, c), joined = opposite && joins_inside(values, corners, c);
      for (unsigned k = 0; k < 4; ++k) {
        const unsigned a = c[k], b = c[(k + 1) % 4];
        if (in(a) == in(b)) pieces.join(a, b);
        if (in(a) || !in(b)) continue;  // the walk enters at b
        unsigned leave = (k + 1) % 4;
        while (in(c[(leave + 1) % 4])) leave = (leave + 1) % 4;
        // Joined corners: the line goes around the outside corner before, to where the walk had left.
        const std::uint8_t to = joined ? edge_between(c[(k + 3) % 4], a) : edge_between(c[leave], c[(leave + 1) % 4]);
        next[edge_between(a, b)] = to;
      }
      if (opposite) {
        const bool even_in = in(c[0]);
        const unsigned first = joined == even_in ? 0 : 1;
        pieces.join(c[first], c[first + 2]);
      }
    }
  }
  TrilinearCube out;
  std::array<bool, 12> seen{};
  for (std::uint8_t start = 0; start < 12; ++start) {
    if (next[start] < 0 || seen[start]) continue;
    std::vector<std::uint8_t> loop;
    for (auto e = start; !seen[e]; e = static_cast<std::uint8_t>(next[e])) {
      seen[e] = true;
      loop.push_back(e);
    }
    out.loops.push_back(std::move(loop));
  }
  if (out.loops.size() != 2) return out;
  const bool inside_parted = pieces.count(corners, true) == 2;
  const std::array<double, 8> f = polynomial(values);
  for (const Vec3d& saddle : saddles(f)) {
    const double value = at(f, saddle);
    out.tunnel = out.tunnel || (inside_parted ? value > 0 : value < 0);
  }
  return out;
}

void make_trilinear_triangles(const InsideRows& rows, const CubeSurface& surface, const ValuesAt& values_at, Mesh& mesh,
                              const Task& task) {
  const auto& cases = cube_cases();
  std::array<bool, 256> ambiguous{};
  for (unsigned c = 0; c < 256; ++c) ambiguous[c] = is_ambiguous(c);
  std::vector<Part> parts(rows.depth - 1);
  parallel_for(parts.size(), 1, task, [&](std::size_t z, std::size_t, std::size_t) {
    SliceMaker maker(mesh, parts[z]);
    for_each_cube(
        rows, surface, static_cast<std::uint32_t>(z),
        [&](std::uint32_t x, std::uint32_t y, std::uint32_t corners, const std::uint32_t* vertex) {
          if (!ambiguous[corners]) {
            const CubeCase& one = cases[corners];
            for (std::size_t t = 0; t < one.triangles; ++t) {
              parts[z].triangles.push_back({vertex[one.edges[t][0]], vertex[one.edges[t][1]], vertex[one.edges[t][2]]});
            }
            return;
          }
          const TrilinearCube cube = trilinear_cube(values_at(x, y, static_cast<std::uint32_t>(z)));
          std::vector<std::vector<std::uint32_t>> rings;
          for (const auto& loop : cube.loops) {
            rings.emplace_back();
            for (const std::uint8_t e : loop) rings.back().push_back(vertex[e]);
          }
          if (cube.tunnel) return maker.add_tube(rings[0], rings[1]);
          for (const auto& ring : rings) maker.add_disk(ring);
        });
  });
  std::size_t triangles = 0;
  for (const Part& part : parts) triangles += part.triangles.size();
  mesh.triangles.reserve(triangles);
  for (const Part& part : parts) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (Triangle t : part.triangles) {
      for (std::uint32_t& v : t) v = v < kOwn ? v : first + (v - kOwn);
      mesh.triangles.push_back(t);
    }
    mesh.positions.insert(mesh.positions.end(), part.vertices.begin(), part.vertices.end());
  }
}

}  // namespace lodestone::voxel::detail
