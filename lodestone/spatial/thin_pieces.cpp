#include <algorithm>
#include <array>
#include <cmath>

#include "lodestone/base/parallel.h"
#include "lodestone/math/triangle.h"
#include "lodestone/spatial/hilbert.h"
#include "lodestone/spatial/thin_pieces_detail.h"

namespace lodestone::spatial::detail {

namespace {

constexpr std::size_t kChunk = 4096;
constexpr double kEmpty = 16;                                  // box to triangle: half the box's surface by the area
constexpr double kMostPieces = 256;                            // of a triangle
constexpr std::size_t kMostLeaves = std::size_t{1} << 30;      // the tree counts them in 32 bits
constexpr std::size_t kMoreBoxes = 4, kFreeBoxes = 1'000'000;  // of all thin triangles: for each triangle, and beside

double half_surface(Vec3d size) { return size.x * size.y + size.y * size.z + size.z * size.x; }

// How empty the boxes of all triangles are, together: 2 to 5 for usual meshes.
struct Fill {
  double boxes = 0, areas = 0, thin_length = 0;  // the last: of the longest edges of those with empty boxes
};

// A triangle with its longest edge from the first to the second corner.
struct Long {
  Vec3d from, to, apex;
  double length = 0, box = 0, area = 0;
  bool is_thin() const { return box > kEmpty * area; }
};

Box3d box_of(const Long& t) {
  Box3d box;
  for (const Vec3d p : {t.from, t.to, t.apex}) box.add(p);
  return box;
}

Long long_way(const Surface& surface, std::size_t t) {
  const auto [a, b, c] = surface.corners(t);
  const double ab = length(b - a), bc = length(c - b), ca = length(a - c);
  Long out = ab >= bc && ab >= ca ? Long{a, b, c, ab} : bc >= ca ? Long{b, c, a, bc} : Long{c, a, b, ca};
  out.box = half_surface(box_of(out).size());
  out.area = 0.5 * length(scaled_normal(a, b, c));
  return out;
}

Fill fill_of(const Surface& surface, const Task& task) {
  return parallel_reduce(
      surface.triangles.size(), kChunk, task, Fill{},
      [&](std::size_t begin, std::size_t end) {
        Fill part;
        for (std::size_t t = begin; t < end; ++t) {
          const Long one = long_way(surface, t);
          part.boxes += one.box;
          part.areas += one.area;
          if (one.is_thin()) part.thin_length += one.length;
        }
        return part;
      },
      [](const Fill& a, const Fill& b) {
        return Fill{a.boxes + b.boxes, a.areas + b.areas, a.thin_length + b.thin_length};
      });
}

// As many as the step gives, and no more than it takes until boxes are full enough.
std::uint32_t cuts_of(const Long& t, double step) {
  if (!t.is_thin() || !(t.length > 0)) return 1;
  const double full = t.area > 0 ? t.box / (kEmpty * t.area) : kMostPieces;
  return static_cast<std::uint32_t>(std::clamp(std::min(t.length / step, full) + 0.5, 1.0, kMostPieces));
}

// What of the triangle lies between two parts of the way along its longest edge.
Box3d slice(const Long& t, double begin, double end) {
  const Vec3d way = t.to - t.from;
  const double turn = std::clamp(dot(t.apex - t.from, way) / dot(way, way), 0.0, 1.0);
  const auto beside = [&](double at) {  // on the two shorter edges
    if (at <= turn) return turn > 0 ? t.from + (t.apex - t.from) * (at / turn) : t.apex;
    return t.to + (t.apex - t.to) * ((1 - at) / (1 - turn));
  };
  Box3d box;
  for (const double at : {begin, end}) {
    box.add(t.from + way * at);
    box.add(beside(at));
  }
  if (begin <= turn && turn <= end) box.add(t.apex);
  return box;
}

// In the order of a Hilbert curve.
std::vector<Piece> ordered(const Surface& surface, const std::vector<Piece>& pieces, const Task& task) {
  struct Key {
    std::uint64_t code;
    std::size_t piece;
  };
  const Vec3d size = surface.bounds.size(), low = surface.bounds.min;
  const double longest = std::max({size.x, size.y, size.z});
  const double cells = longest > 0 ? 65535.0 / longest : 0;
  const auto cell = [](double x) { return static_cast<std::uint32_t>(x > 0 ? std::min(x, 65535.0) : 0.0); };
  std::vector<Key> keys(pieces.size());
  parallel_for(pieces.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3d p = (pieces[i].box.center() - low) * cells;
      keys[i] = {hilbert_key(cell(p.x), cell(p.y), cell(p.z)), i};
    }
  });
  parallel_sort(keys, task, [](const Key& a, const Key& b) { return a.code < b.code; });
  std::vector<Piece> sorted(pieces.size());
  parallel_for(pieces.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) sorted[i] = pieces[keys[i].piece];
  });
  return sorted;
}

}  // namespace

std::vector<Piece> thin_pieces(const Surface& surface, const Task& task) {
  const std::size_t count = surface.triangles.size();
  const Fill fill = fill_of(surface, task);
  if (!(fill.boxes > kEmpty * fill.areas) || !std::isfinite(fill.boxes) || !(fill.thin_length > 0)) return {};
  // A sliver of length L in k pieces has boxes of L²/k: for a number of pieces their sum is least where k grows with L.
  const double step = fill.thin_length / static_cast<double>(kMoreBoxes * count + kFreeBoxes);
  // Pieces are counted first, so that all chunks can make theirs at once.
  std::vector<std::size_t> first(count + 1, 0);
  parallel_for(count, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) first[t + 1] = cuts_of(long_way(surface, t), step);
  });
  if (task.cancelled()) return {};
  for (std::size_t t = 0; t < count; ++t) first[t + 1] += first[t];
  if (first[count] > kMostLeaves) return {};
  std::vector<Piece> pieces(first[count]);
  parallel_for(count, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) {
      const Long one = long_way(surface, t);
      const std::size_t cuts = first[t + 1] - first[t];
      for (std::size_t k = 0; k < cuts; ++k) {
        const double from = double(k) / double(cuts), to = double(k + 1) / double(cuts);
        pieces[first[t] + k] = {cuts == 1 ? box_of(one) : slice(one, from, to), static_cast<std::uint32_t>(t)};
      }
    }
  });
  if (task.cancelled()) return {};
  return ordered(surface, pieces, task);
}

}  // namespace lodestone::spatial::detail
