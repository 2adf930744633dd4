// Turning diagonals (Lawson 1977) until the triangles of a polygon are constrained Delaunay.
#include <cmath>

#include "lodestone/io/plain/polygon_ears_detail.h"

namespace lodestone::io {

namespace {

constexpr std::uint64_t kTurnsPerCorner = 8;

// Whether the two angles that look at the diagonal p-q, from r and from s, come to more than half a turn. By a margin,
// so that four corners on a circle stay as they are and rounding can't turn a diagonal for ever.
bool is_better_turned(Vec2d p, Vec2d q, Vec2d r, Vec2d s, double sign) {
  const auto dot2 = [](Vec2d at, Vec2d a, Vec2d b) {
    return (a.x - at.x) * (b.x - at.x) + (a.y - at.y) * (b.y - at.y);
  };
  const double sin_r = sign * cross2(r, p, q), cos_r = dot2(r, p, q);
  const double sin_s = sign * cross2(s, q, p), cos_s = dot2(s, q, p);
  constexpr double kMargin = 1e-9;
  const double scale = (std::abs(sin_r) + std::abs(cos_r)) * (std::abs(sin_s) + std::abs(cos_s));
  return sin_r * cos_s + cos_r * sin_s < -kMargin * scale;
}

// Turned, the diagonal would lie inside, and neither triangle turns over.
bool can_turn(Vec2d p, Vec2d q, Vec2d r, Vec2d s, double sign) {
  return sign * cross2(p, q, r) >= 0 && sign * cross2(q, p, s) >= 0 && sign * cross2(r, p, s) > 0 &&
         sign * cross2(s, q, r) > 0;
}

}  // namespace

void turn_diagonals(std::span<const Vec2d> corners, PolygonTriangles triangles) {
  std::vector<CornerTriple>& triples = triangles.triples;
  std::vector<std::uint32_t>& twin = triangles.twin;
  constexpr std::uint32_t kNoTwin = PolygonTriangles::kNoTwin;
  std::vector<std::uint32_t> suspects;
  for (auto h = static_cast<std::uint32_t>(twin.size()); h-- > 0;) {
    if (twin[h] != kNoTwin && h < twin[h]) suspects.push_back(h);
  }
  const auto next = [](std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; };
  const auto corner_of = [&](std::uint32_t h) { return triples[h / 3][h % 3]; };
  const auto set = [&](std::uint32_t h, std::uint32_t other) {
    twin[h] = other;
    if (other == kNoTwin) return;
    twin[other] = h;
    suspects.push_back(h);
  };
  std::uint64_t turns_left = kTurnsPerCorner * corners.size();
  while (!suspects.empty() && turns_left > 0) {
    const std::uint32_t h = suspects.back(), g = twin[h];
    suspects.pop_back();
    if (g == kNoTwin) continue;
    const std::uint32_t p = corner_of(h), q = corner_of(g), r = corner_of(next(next(h))), s = corner_of(next(next(g)));
    const double sign =
        cross2(corners[p], corners[q], corners[r]) + cross2(corners[q], corners[p], corners[s]) < 0 ? -1 : 1;
    if (!can_turn(corners[p], corners[q], corners[r], corners[s], sign) ||
        !is_better_turned(corners[p], corners[q], corners[r], corners[s], sign)) {
      continue;
    }
    const std::uint32_t rp = twin[next(next(h))], qr = twin[next(h)], sq = twin[next(next(g))], ps = twin[next(g)];
    const std::uint32_t t = h / 3, u = g / 3;
    triples[t] = {r, p, s};
    triples[u] = {s, q, r};
    set(3 * t, rp);
    set(3 * t + 1, ps);
    set(3 * u, sq);
    set(3 * u + 1, qr);
    twin[3 * t + 2] = 3 * u + 2;
    twin[3 * u + 2] = 3 * t + 2;
    --turns_left;
  }
}

}  // namespace lodestone::io
