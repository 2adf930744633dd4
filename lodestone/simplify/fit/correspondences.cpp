// How far a level is from its original: correspondences, found once and brought up to date while the level changes.
//
// A correspondence joins a point of the level to a point of the original: points of the original to the closest point
// of the level, and points of each triangle of the level to the closest point of the original. Weights are shares of
// area, so sums stand for integrals over both surfaces (docs/papers/measured-feedback.md, "Correspondences").
//
// find_correspondences():
// 1. tie_points(): every stride_for()-th point of the original asks the level's tree. tie_level(): three inner points
//    of each triangle of the level ask the original's tree.
//    With a Known level, same_triangles() finds what both levels have in common. keep_points() and keep_level() then
//    look again only where a new triangle could be nearer (NearMask), or an old one is gone.
// 2. sort_by_triangle() groups them; add_up() sums mean and energy in a fixed order.
// 3. probe_corners(): the distance of each vertex of the level, for the maximum.
// update_correspondences() does the same for pairs of triangles whose common edge has been turned.
// probe_worst_errors() looks closely at triangles whose error comes near the maximum: at lattices of points, wide ones
// and then narrow ones, never twice on the same triangle.
//
// The same bytes for any number of threads. O((points + triangles) log triangles).
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "lodestone/base/index_table.h"
#include "lodestone/base/parallel.h"
#include "lodestone/base/random.h"
#include "lodestone/math/box.h"
#include "lodestone/math/triangle.h"
#include "lodestone/simplify/fit/correspondences_detail.h"
#include "lodestone/spatial/closest_batch.h"

namespace lodestone::simplify::detail {

namespace {

constexpr std::size_t kChunk = 4096;

Correspondence correspondence_at(const spatial::Surface& level, std::uint32_t triangle, Vec3d on_level, float weight,
                                 Vec3d partner) {
  const auto [a, b, c] = level.corners(triangle);
  const std::array<double, 3> w = barycentric(on_level, a, b, c);
  return {triangle, static_cast<float>(w[1]), static_cast<float>(w[2]), weight, partner};
}

// Every stride-th point of the original is enough for a level: some 24 a triangle, and 100,000 on top.
std::size_t stride_for(std::size_t points, std::size_t triangles) {
  return std::max<std::size_t>(1, points / (24 * triangles + 100'000));
}

// From points of the original to the level, every `stride`-th.
void tie_points(const FitTarget& target, const spatial::Surface& level, const spatial::Bvh& tree, std::size_t stride,
                std::span<Correspondence> correspondences, const Task& task) {
  const auto factor = static_cast<float>(stride);
  parallel_for(correspondences.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<Vec3d> points;
    for (std::size_t i = begin; i < end; ++i) points.push_back(target.points()[i * stride]);
    std::vector<spatial::Nearest> closest(end - begin);
    spatial::ClosestBatch(tree).find(points, closest);
    for (std::size_t i = begin; i < end; ++i) {
      const spatial::Nearest& near = closest[i - begin];
      correspondences[i] =
          correspondence_at(level, near.triangle, near.point, factor * target.weights()[i * stride], points[i - begin]);
    }
  });
}

double area_of(const spatial::Surface& level) {
  double area = 0;
  for (std::size_t t = 0; t < level.triangles.size(); ++t) {
    const auto [a, b, c] = level.corners(t);
    area += length(scaled_normal(a, b, c)) / 2;
  }
  return area;
}

// A correspondence for the k-th point of a triangle of the level, its partner not yet found. `area`: of the level.
Correspondence level_correspondence(std::size_t t, const std::array<Vec3d, 3>& corners, std::size_t k, double area) {
  const double own = length(scaled_normal(corners[0], corners[1], corners[2])) / 2;
  return {static_cast<std::uint32_t>(t),
          kInner[k][0],
          kInner[k][1],
          area > 0 ? static_cast<float>(own / area / std::size(kInner)) : 0.0F,
          {}};
}

// Moves a correspondence of a point of the original to the nearer of two triangles.
void join_nearer(const TrianglePair& pair, const std::array<std::array<Vec3d, 3>, 2>& corners,
                 Correspondence& correspondence) {
  ClosestPoint best{{}, std::numeric_limits<double>::infinity()};
  for (std::size_t side = 0; side < 2; ++side) {
    const auto& [a, b, c] = corners[side];
    const ClosestPoint found = closest_point(correspondence.partner, a, b, c);
    if (!(found.distance_sq < best.distance_sq)) continue;
    best = found;
    const std::array<double, 3> w = barycentric(found.point, a, b, c);
    correspondence.triangle = pair[side];
    correspondence.second = static_cast<float>(w[1]);
    correspondence.third = static_cast<float>(w[2]);
  }
}

// From points of the level to the original: inner points of each triangle, and its corners.
void tie_level(const FitTarget& target, const spatial::Surface& level, std::span<Correspondence> correspondences,
               const Task& task) {
  const double area = area_of(level);
  constexpr std::size_t kEach = std::size(kInner);
  parallel_for(level.triangles.size(), kChunk / kEach, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<Vec3d> points;
    std::vector<spatial::Nearest> closest((end - begin) * kEach);
    for (std::size_t t = begin; t < end; ++t) {
      const std::array<Vec3d, 3> corners = level.corners(t);
      for (std::size_t k = 0; k < kEach; ++k) {
        Correspondence& correspondence = correspondences[t * kEach + k];
        correspondence = level_correspondence(t, corners, k, area);
        points.push_back(correspondence.on(corners));
      }
    }
    spatial::ClosestBatch(target.tree()).find(points, closest);
    for (std::size_t i = 0; i < points.size(); ++i) correspondences[begin * kEach + i].partner = closest[i].point;
  });
}

void sort_by_triangle(Correspondences& correspondences, std::vector<Correspondence> loose, std::size_t triangles) {
  correspondences.first.assign(triangles + 1, 0);
  for (const Correspondence& correspondence : loose) ++correspondences.first[correspondence.triangle];
  exclusive_scan(correspondences.first);
  std::vector<std::uint32_t> next(correspondences.first.begin(), correspondences.first.end() - 1);
  correspondences.list.resize(loose.size());
  for (const Correspondence& correspondence : loose)
    correspondences.list[next[correspondence.triangle]++] = correspondence;
}

void raise(TriangleError& worst, const TriangleError& other) {
  if (other.distance > worst.distance) worst = other;
}

// Finds the distances of the level's vertices that are not known, and raises the worst of all triangles around them.
void probe_corners(const FitTarget& target, const spatial::Surface& level, const std::vector<std::uint8_t>& is_known,
                   Correspondences& correspondences, const Task& task) {
  std::vector<std::uint32_t> wanted;
  for (std::uint32_t v = 0; v < level.positions.size(); ++v) {
    if (is_known.empty() || is_known[v] == 0) wanted.push_back(v);
  }
  correspondences.corner.resize(level.positions.size());
  parallel_for(wanted.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<Vec3d> points;
    for (std::size_t i = begin; i < end; ++i) points.push_back(level.positions[wanted[i]]);
    std::vector<spatial::Nearest> closest(end - begin);
    spatial::ClosestBatch(target.tree()).find(points, closest);
    for (std::size_t i = begin; i < end; ++i) {
      const spatial::Nearest& near = closest[i - begin];
      correspondences.corner[wanted[i]] = {static_cast<float>(std::sqrt(near.distance_sq)), 0, 0, near.point};
    }
  });
  for (std::size_t t = 0; t < level.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      TriangleError worst = correspondences.corner[level.triangles[t][k]];
      worst.second = k == 1 ? 1.0F : 0.0F;
      worst.third = k == 2 ? 1.0F : 0.0F;
      raise(correspondences.worst[t], worst);
    }
  }
}

void add_up(const spatial::Surface& level, Correspondences& correspondences, const Task& task) {
  correspondences.worst.assign(level.triangles.size(), {});
  struct Sum {
    double mean = 0, energy = 0;
  };
  const Sum sum = parallel_reduce(
      level.triangles.size(), kChunk, task, Sum{},
      [&](std::size_t begin, std::size_t end) {
        Sum part;
        for (std::size_t t = begin; t < end; ++t) {
          const std::array<Vec3d, 3> corners = level.corners(t);
          double worst_sq = -1;
          std::uint32_t worst = 0;
          for (std::uint32_t i = correspondences.first[t]; i < correspondences.first[t + 1]; ++i) {
            const Correspondence& correspondence = correspondences.list[i];
            const double d_sq = length_sq(correspondence.partner - correspondence.on(corners));
            const double w = static_cast<double>(correspondence.weight);
            part.mean += w * std::sqrt(d_sq);
            part.energy += w * d_sq;
            if (d_sq > worst_sq) {
              worst_sq = d_sq;
              worst = i;
            }
          }
          if (worst_sq < 0) continue;
          const Correspondence& correspondence = correspondences.list[worst];
          correspondences.worst[t] = {static_cast<float>(std::sqrt(worst_sq)), correspondence.second,
                                      correspondence.third, correspondence.partner};
        }
        return part;
      },
      [](Sum a, Sum b) {
        return Sum{a.mean + b.mean, a.energy + b.energy};
      });
  correspondences.mean = sum.mean / 2;
  correspondences.energy = sum.energy;
}

// For each triangle, the one of the other surface with the same corners in the same order; kNone where there is none.
std::vector<std::uint32_t> same_triangles(const spatial::Surface& of, const spatial::Surface& in) {
  const auto hash = [](const spatial::Surface& surface, std::size_t t) {
    std::uint64_t h = 0;
    for (const Vec3d& p : surface.corners(t)) {
      for (std::size_t k = 0; k < 3; ++k) h = mix_bits(h ^ std::bit_cast<std::uint64_t>(p[k]));
    }
    return h;
  };
  IndexTable table(in.triangles.size());
  for (std::uint32_t t = 0; t < in.triangles.size(); ++t) {
    table.find_or_add(hash(in, t), t, [&](std::size_t other) { return in.corners(other) == in.corners(t); });
  }
  std::vector<std::uint32_t> same(of.triangles.size(), kNone);
  for (std::size_t t = 0; t < of.triangles.size(); ++t) {
    same[t] = table.find(hash(of, t), [&](std::size_t other) { return in.corners(other) == of.corners(t); });
  }
  return same;
}

// The triangles of the level that are new, as a surface; `drawn` numbers those of the level.
spatial::Surface new_triangles(const spatial::Surface& level, const std::vector<std::uint32_t>& old_of) {
  spatial::Surface out;
  out.positions = level.positions;
  for (std::uint32_t t = 0; t < old_of.size(); ++t) {
    if (old_of[t] != kNone) continue;
    out.triangles.push_back(level.triangles[t]);
    out.drawn.push_back(t);
    for (const Vec3d& p : level.corners(t)) out.bounds.add(p);
  }
  return out;
}

// The cells of a grid over a surface in which a point could be nearer than `reach` to one of its triangles.
class NearMask {
 public:
  NearMask(const spatial::Surface& surface, double reach) : origin_(surface.bounds.min - Vec3d{reach, reach, reach}) {
    const Vec3d size = surface.bounds.size() + Vec3d{2 * reach, 2 * reach, 2 * reach};
    for (std::size_t k = 0; k < 3; ++k) scale_[k] = size[k] > 0 ? kCells / size[k] : 0;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      Box3d box;
      for (const Vec3d& p : surface.corners(t)) box.add(p);
      std::uint32_t low[3], high[3];
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = cell(box.min[k] - reach, k);
        high[k] = cell(box.max[k] + reach, k);
      }
      for (std::uint32_t z = low[2]; z <= high[2]; ++z) {
        for (std::uint32_t y = low[1]; y <= high[1]; ++y) {
          rows_[z * kCells + y] |= (~std::uint64_t{0} >> (63 - (high[0] - low[0]))) << low[0];
        }
      }
    }
  }

  bool maybe_near(Vec3d p) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const double place = (p[k] - origin_[k]) * scale_[k];
      if (!(place >= 0 && place <= kCells)) return false;
    }
    return (rows_[cell(p.z, 2) * kCells + cell(p.y, 1)] >> cell(p.x, 0) & 1) != 0;
  }

 private:
  static constexpr std::uint32_t kCells = 64;
  std::uint32_t cell(double at, std::size_t k) const {
    return static_cast<std::uint32_t>(std::clamp((at - origin_[k]) * scale_[k], 0.0, kCells - 1.0));
  }
  Vec3d origin_, scale_;
  std::vector<std::uint64_t> rows_ = std::vector<std::uint64_t>(std::size_t{kCells} * kCells, 0);
};

// As tie_points(), but a correspondence whose triangle is still there is taken over, unless a new triangle is nearer.
void keep_points(const spatial::Surface& level, const spatial::Bvh& tree, const spatial::Surface& fresh,
                 const std::vector<std::uint32_t>& new_of, const Known& known,
                 std::span<Correspondence> correspondences, const Task& task) {
  constexpr std::size_t kEach = std::size(kInner);
  const std::optional<spatial::Bvh> fresh_tree =
      fresh.triangles.empty() ? std::nullopt : std::make_optional<spatial::Bvh>(fresh);
  const NearMask mask(fresh, known.correspondences.max);
  parallel_for(new_of.size(), kChunk / 8, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<spatial::Nearest> near;
    std::vector<std::uint32_t> lost;  // correspondences whose triangle is gone
    for (std::size_t old = begin; old < end; ++old) {
      // Correspondences of the original's points before this triangle: all correspondences less the level's.
      const std::uint32_t first = known.correspondences.first[old],
                          last = known.correspondences.first[old + 1] - std::uint32_t{kEach};
      for (std::uint32_t i = first; i < last; ++i) {
        const auto at = static_cast<std::uint32_t>(i - old * kEach);
        Correspondence& correspondence = correspondences[at];
        correspondence = known.correspondences.list[i];
        const Vec3d p = correspondence.partner;
        if (new_of[old] == kNone) {
          lost.push_back(at);
          continue;
        }
        correspondence.triangle = new_of[old];
        if (!fresh_tree) continue;
        double best_sq = length_sq(p - correspondence.on(level.corners(correspondence.triangle)));
        if (!(best_sq > 0) || !mask.maybe_near(p)) continue;
        near.clear();
        fresh_tree->all_within(p, std::sqrt(best_sq), near);
        for (const spatial::Nearest& n : near) {
          if (!(n.distance_sq < best_sq)) continue;
          best_sq = n.distance_sq;
          correspondence = correspondence_at(level, fresh.drawn[n.triangle], n.point, correspondence.weight, p);
        }
      }
    }
    std::vector<Vec3d> points;
    for (const std::uint32_t at : lost) points.push_back(correspondences[at].partner);
    std::vector<spatial::Nearest> closest(points.size());
    spatial::ClosestBatch(tree).find(points, closest);
    for (std::size_t i = 0; i < lost.size(); ++i) {
      Correspondence& correspondence = correspondences[lost[i]];
      correspondence =
          correspondence_at(level, closest[i].triangle, closest[i].point, correspondence.weight, points[i]);
    }
  });
}

// As tie_level(), but only for the new triangles; the others' partners are taken over.
void keep_level(const FitTarget& target, const spatial::Surface& level, const std::vector<std::uint32_t>& old_of,
                const Known& known, std::span<Correspondence> correspondences, const Task& task) {
  const double area = area_of(level);
  constexpr std::size_t kEach = std::size(kInner);
  parallel_for(level.triangles.size(), kChunk / 8, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<std::size_t> wanted;
    std::vector<Vec3d> points;
    for (std::size_t t = begin; t < end; ++t) {
      const std::array<Vec3d, 3> corners = level.corners(t);
      for (std::size_t k = 0; k < kEach; ++k) {
        Correspondence& correspondence = correspondences[t * kEach + k];
        correspondence = level_correspondence(t, corners, k, area);
        if (old_of[t] != kNone) {
          correspondence.partner =
              known.correspondences.list[known.correspondences.first[old_of[t] + 1] - kEach + k].partner;
          continue;
        }
        wanted.push_back(t * kEach + k);
        points.push_back(correspondence.on(corners));
      }
    }
    std::vector<spatial::Nearest> closest(points.size());
    spatial::ClosestBatch(target.tree()).find(points, closest);
    for (std::size_t i = 0; i < wanted.size(); ++i) correspondences[wanted[i]].partner = closest[i].point;
  });
}

}  // namespace

Correspondences find_correspondences(const FitTarget& target, const spatial::Surface& level, const Task& task,
                                     const Known* known) {
  Correspondences correspondences;
  const std::size_t triangles = level.triangles.size(), all = target.points().size();
  if (triangles == 0 || all == 0) return correspondences;
  const bool updates = known != nullptr && !known->correspondences.list.empty();
  const std::size_t stride = stride_for(all, triangles);
  const std::size_t points =
      updates ? known->correspondences.list.size() - known->level.triangles.size() * std::size(kInner)
              : (all + stride - 1) / stride;
  const spatial::Bvh tree(level, task);
  std::vector<Correspondence> loose(points + triangles * std::size(kInner));
  const std::span<Correspondence> of_points = std::span(loose).first(points),
                                  of_level = std::span(loose).subspan(points);
  correspondences.close.assign(triangles, {});
  correspondences.corner.assign(level.positions.size(), {});
  std::vector<std::uint8_t> corner_known;
  if (updates) {
    const std::vector<std::uint32_t> old_of = same_triangles(level, known->level);
    corner_known.resize(level.positions.size(), 0);
    std::vector<std::uint32_t> new_of(known->level.triangles.size(), kNone);
    for (std::uint32_t t = 0; t < triangles; ++t) {
      if (old_of[t] == kNone) continue;
      new_of[old_of[t]] = t;
      correspondences.close[t] = known->correspondences.close[old_of[t]];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = level.triangles[t][k];
        correspondences.corner[v] = known->correspondences.corner[known->level.triangles[old_of[t]][k]];
        corner_known[v] = 1;
      }
    }
    keep_points(level, tree, new_triangles(level, old_of), new_of, *known, of_points, task);
    keep_level(target, level, old_of, *known, of_level, task);
  } else {
    tie_points(target, level, tree, stride, of_points, task);
    tie_level(target, level, of_level, task);
  }
  sort_by_triangle(correspondences, std::move(loose), triangles);
  add_up(level, correspondences, task);
  probe_corners(target, level, corner_known, correspondences, task);
  for (std::size_t t = 0; t < triangles; ++t) {
    raise(correspondences.worst[t], correspondences.close[t]);
    correspondences.max = std::max(correspondences.max, static_cast<double>(correspondences.worst[t].distance));
  }
  return correspondences;
}

void update_correspondences(const FitTarget& target, const spatial::Surface& level,
                            const std::vector<TrianglePair>& changed, Correspondences& correspondences,
                            const Task& task) {
  if (changed.empty()) return;
  constexpr std::size_t kEach = std::size(kInner);
  const double area = area_of(level);
  parallel_for(changed.size(), 64, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::array<std::array<Vec3d, 3>, 2> corners{level.corners(changed[i][0]), level.corners(changed[i][1])};
      std::uint32_t hint = kNone;
      for (std::size_t side = 0; side < 2; ++side) {
        const std::uint32_t t = changed[i][side], last = correspondences.first[t + 1];
        for (std::uint32_t k = correspondences.first[t]; k + kEach < last; ++k)
          join_nearer(changed[i], corners, correspondences.list[k]);
        for (std::size_t k = 0; k < kEach; ++k) {
          Correspondence& correspondence = correspondences.list[last - kEach + k];
          correspondence = level_correspondence(t, corners[side], k, area);
          const spatial::Nearest near = target.tree().closest(correspondence.on(corners[side]), hint);
          hint = near.triangle;
          correspondence.partner = near.point;
        }
      }
    }
  });
  // In each triangle those of the original come first, in the order that they had, and the points of the level last.
  std::vector<Correspondence> loose;
  loose.reserve(correspondences.list.size());
  for (const bool own : {false, true}) {
    for (std::size_t t = 0; t < level.triangles.size(); ++t) {
      const std::uint32_t begin = correspondences.first[t], end = correspondences.first[t + 1],
                          middle = end - std::uint32_t{kEach};
      const auto part = std::span(correspondences.list).subspan(own ? middle : begin, own ? kEach : middle - begin);
      loose.insert(loose.end(), part.begin(), part.end());
    }
  }
  sort_by_triangle(correspondences, std::move(loose), level.triangles.size());
  add_up(level, correspondences, task);
}

void probe_worst_errors(const FitTarget& target, const spatial::Surface& level, double share,
                        Correspondences& correspondences, const Task& task) {
  // Lattices of points: a wide one first, a narrow one where that finds something near to the maximum.
  constexpr int kWide = 4, kNarrow = 10;
  constexpr double kPromising = 0.7;
  std::vector<std::uint32_t> suspects;
  for (std::uint32_t t = 0; t < level.triangles.size(); ++t) {
    const bool looked = correspondences.close[t].distance > 0;
    if (!looked && static_cast<double>(correspondences.worst[t].distance) > share * correspondences.max)
      suspects.push_back(t);
  }
  const double promising = kPromising * correspondences.max;
  parallel_for(suspects.size(), 16, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<Vec3d> points;
    std::vector<std::array<float, 2>> shares;
    std::vector<spatial::Nearest> closest;
    spatial::ClosestBatch batch(target.tree());
    const auto look = [&](std::uint32_t t, int steps) {
      const auto [a, b, c] = level.corners(t);
      points.clear();
      shares.clear();
      for (int i = 0; i <= steps; ++i) {
        for (int j = 0; i + j <= steps; ++j) {
          const double second = static_cast<double>(i) / steps, third = static_cast<double>(j) / steps;
          points.push_back(a + (b - a) * second + (c - a) * third);
          shares.push_back({static_cast<float>(second), static_cast<float>(third)});
        }
      }
      closest.assign(points.size(), {});
      batch.find(points, closest);
      for (std::size_t i = 0; i < points.size(); ++i) {
        raise(correspondences.close[t],
              {static_cast<float>(std::sqrt(closest[i].distance_sq)), shares[i][0], shares[i][1], closest[i].point});
      }
      raise(correspondences.worst[t], correspondences.close[t]);
    };
    for (std::size_t k = begin; k < end; ++k) {
      look(suspects[k], kWide);
      if (static_cast<double>(correspondences.worst[suspects[k]].distance) > promising) look(suspects[k], kNarrow);
    }
  });
  for (const TriangleError& worst : correspondences.worst)
    correspondences.max = std::max(correspondences.max, static_cast<double>(worst.distance));
}

}  // namespace lodestone::simplify::detail
