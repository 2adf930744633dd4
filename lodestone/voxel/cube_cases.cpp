// Made, not listed: the lines on the six faces are joined to loops, and the loops cut into triangles.
// Source: W. Lorensen and H. Cline, Marching Cubes, SIGGRAPH 1987; faces decided as in C. Montani, R. Scateni and
// R. Scopigno, A modified look-up table for implicit disambiguation of Marching Cubes, 1994.
#include "lodestone/voxel/cube_cases_detail.h"

#include <vector>

#include "lodestone/base/check.h"

namespace lodestone::voxel::detail {

namespace {

using Loop = std::vector<std::uint8_t>;  // edges, in the order of the surface's border

// The edge between two corners that differ in one axis.
std::uint8_t edge_between(unsigned a, unsigned b) {
  const unsigned axis = (a ^ b) >> 1;  // 1 -> 0, 2 -> 1, 4 -> 2
  const unsigned low = a & b;
  for (std::uint8_t e = 0; e < 12; ++e) {
    if (e / 4U == axis && kEdgeCorner[e] == low) return e;
  }
  LODESTONE_CHECK(false, "corners of an edge");
  return 0;
}

// The corners of a face, counter-clockwise seen from outside the cube.
std::array<unsigned, 4> face_corners(unsigned axis, bool high) {
  const unsigned u = 1U << ((axis + 1) % 3), v = 1U << ((axis + 2) % 3), base = high ? 1U << axis : 0U;
  if (high) return {base, base | u, base | u | v, base | v};
  return {base, base | v, base | u | v, base | u};
}

// next[e]: where the border of the surface goes from edge e, across one face. Walking around a face from outside, the
// line from where the walk leaves the inside to where it entered it keeps the inside on its right.
std::array<int, 12> border_lines(unsigned inside) {
  std::array<int, 12> next;
  next.fill(-1);
  const auto is_in = [&](unsigned corner) { return (inside >> corner & 1) != 0; };
  for (unsigned axis = 0; axis < 3; ++axis) {
    for (const bool high : {false, true}) {
      const std::array<unsigned, 4> c = face_corners(axis, high);
      for (unsigned k = 0; k < 4; ++k) {
        if (is_in(c[k]) || !is_in(c[(k + 1) % 4])) continue;  // the walk enters here,
        unsigned leave = (k + 1) % 4;
        while (is_in(c[(leave + 1) % 4])) leave = (leave + 1) % 4;  // and leaves after this corner
        next[edge_between(c[k], c[(k + 1) % 4])] = edge_between(c[leave], c[(leave + 1) % 4]);
      }
    }
  }
  return next;
}

std::vector<Loop> loops_of(unsigned inside) {
  const std::array<int, 12> next = border_lines(inside);
  std::array<bool, 12> seen{};
  std::vector<Loop> loops;
  for (std::uint8_t start = 0; start < 12; ++start) {
    if (next[start] < 0 || seen[start]) continue;
    Loop loop;
    for (auto e = start; !seen[e]; e = static_cast<std::uint8_t>(next[e])) {
      seen[e] = true;
      loop.push_back(e);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

bool on_one_face(std::uint8_t a, std::uint8_t b) {
  const auto corners = [](std::uint8_t e) {
    return std::array<unsigned, 2>{kEdgeCorner[e], kEdgeCorner[e] | 1U << (e / 4)};
  };
  const auto [a0, a1] = corners(a);
  const auto [b0, b1] = corners(b);
  const unsigned all_and = a0 & a1 & b0 & b1, all_or = a0 | a1 | b0 | b1;
  return all_and != 0 || all_or != 7;
}

// Ears are cut off whose new side does not lie in a face. True when it went to the end.
bool cut(const Loop& loop, CubeCase& out) {
  if (loop.size() < 3) return true;
  const std::size_t n = loop.size();
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint8_t a = loop[k], b = loop[(k + 1) % n], c = loop[(k + 2) % n];
    if (n > 3 && on_one_face(a, c)) continue;
    CubeCase tried = out;
    tried.edges[tried.triangles++] = {a, b, c};
    Loop rest = loop;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>((k + 1) % n));
    if (n == 3) rest.clear();
    if (!cut(rest, tried)) continue;
    out = tried;
    return true;
  }
  return false;
}

std::array<CubeCase, 256> make_cases() {
  std::array<CubeCase, 256> cases{};
  for (unsigned inside = 0; inside < 256; ++inside) {
    for (const Loop& loop : loops_of(inside)) {
      LODESTONE_CHECK(cut(loop, cases[inside]), "a loop of a cube can be cut without sides in faces");
    }
  }
  return cases;
}

std::array<CubeLoops, 256> make_loops() {
  std::array<CubeLoops, 256> all{};
  for (unsigned inside = 0; inside < 256; ++inside) {
    CubeLoops& out = all[inside];
    std::size_t at = 0;
    for (const Loop& loop : loops_of(inside)) {
      out.length[out.count++] = static_cast<std::uint8_t>(loop.size());
      for (const std::uint8_t edge : loop) out.edges[at++] = edge;
    }
  }
  return all;
}

}  // namespace

const std::array<CubeLoops, 256>& cube_loops() {
  static const std::array<CubeLoops, 256> loops = make_loops();
  return loops;
}

const std::array<CubeCase, 256>& cube_cases() {
  static const std::array<CubeCase, 256> cases = make_cases();
  return cases;
}

}  // namespace lodestone::voxel::detail
