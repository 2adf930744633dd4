// One step of all vertices towards where the sum of squared distances of the correspondences is least ([hoppe-1993],
// with distances both ways; docs/papers/measured-feedback.md, "Moving vertices").
//
// solve_displacements(): Gauss and Newton. The partner of each correspondence is fixed, and only the distance along it
// counts, so the level may slide over the original.
// 1. element_of(): each triangle's blocks of 3 x 3 for pairs of its corners, and the pull on each corner.
// 2. The sum over each vertex's triangles (corners_at()), damped by a share of the weights there.
// 3. Conjugate gradients, preconditioned by the inverse diagonal blocks: at most kSteps steps.
//
// apply_displacements(): a Mover takes the moves as far as the surface bears it.
// 1. settle(): moves of vertices at bad triangles (is_bad(): turned too far, facing away from the original, folded onto
//    a neighbour) are halved, five times, and then dropped, until no triangle is bad.
// 2. uncross(): moves at triangles that have come to cross others are dropped; then settle() again, until none cross.
//
// Vertices with no_move are not moved. Sums are made vertex by vertex and joined in a fixed order: the same bytes for
// any number of threads. O(correspondences + steps * triangles) to solve, O(n log n) to apply.
#include <algorithm>
#include <array>
#include <cmath>

#include "lodestone/base/parallel.h"
#include "lodestone/math/triangle.h"
#include "lodestone/simplify/fit/solve_detail.h"
#include "lodestone/spatial/neighbors.h"
#include "lodestone/spatial/self_intersections.h"

namespace lodestone::simplify::detail {

namespace {

constexpr std::size_t kChunk = 1024;
constexpr int kSteps = 25;
constexpr double kEnough = 1e-6;  // of the first residual's square
constexpr double kTurn = 0.3;     // cosine: a face may not turn farther in one step
constexpr double kFold = -0.98;   // cosine between neighbours' normals

// A symmetric 3 x 3 matrix: xx, xy, xz, yy, yz, zz.
using Sym = std::array<double, 6>;

void add_outer(Sym& m, Vec3d u, double s) {
  m[0] += s * u.x * u.x;
  m[1] += s * u.x * u.y;
  m[2] += s * u.x * u.z;
  m[3] += s * u.y * u.y;
  m[4] += s * u.y * u.z;
  m[5] += s * u.z * u.z;
}

Vec3d times(const Sym& m, Vec3d v) {
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[1] * v.x + m[3] * v.y + m[4] * v.z,
          m[2] * v.x + m[4] * v.y + m[5] * v.z};
}

// The inverse of a positive definite matrix; zero where it is not one.
Sym inverse(const Sym& m) {
  const double c0 = m[3] * m[5] - m[4] * m[4], c1 = m[2] * m[4] - m[1] * m[5], c2 = m[1] * m[4] - m[2] * m[3];
  const double det = m[0] * c0 + m[1] * c1 + m[2] * c2;
  if (!(det > 0) || !std::isfinite(1 / det)) return {};
  const double s = 1 / det;
  return {c0 * s,
          c1 * s,
          c2 * s,
          (m[0] * m[5] - m[2] * m[2]) * s,
          (m[1] * m[2] - m[0] * m[4]) * s,
          (m[0] * m[3] - m[1] * m[1]) * s};
}

constexpr std::size_t kPair[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

// A triangle's share of the system: blocks for pairs of its corners, and what pulls at each.
struct Element {
  std::array<Sym, 6> block{};
  std::array<Vec3d, 3> pull{};
  std::array<double, 3> weight{};
};

Element element_of(const spatial::Surface& level, const Correspondences& correspondences, std::size_t t) {
  Element e;
  const std::array<Vec3d, 3> corners = level.corners(t);
  const Vec3d normal = normalized(scaled_normal(corners[0], corners[1], corners[2]));
  for (std::uint32_t i = correspondences.first[t]; i < correspondences.first[t + 1]; ++i) {
    const Correspondence& correspondence = correspondences.list[i];
    const double s = static_cast<double>(correspondence.second), r = static_cast<double>(correspondence.third);
    const double w[3] = {1 - s - r, s, r};
    const Vec3d to = correspondence.partner - correspondence.on(corners);
    const double d = length(to), weight = static_cast<double>(correspondence.weight);
    const Vec3d u = d > 0 ? to / d : normal;
    Sym outer{};
    add_outer(outer, u, weight);
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t l = k; l < 3; ++l) {
        Sym& block = e.block[kPair[k][l]];
        for (std::size_t c = 0; c < 6; ++c) block[c] += w[k] * w[l] * outer[c];
      }
      e.pull[k] += u * (weight * w[k] * d);
      e.weight[k] += weight * w[k] * w[k];
    }
  }
  return e;
}

// Does a face turn too far?
bool turns(Vec3d before, Vec3d after) {
  const double lengths = length(before) * length(after);
  return !(dot(before, after) >= kTurn * lengths);
}

}  // namespace

CornersAt corners_at(const spatial::Surface& level) {
  CornersAt at;
  at.first.assign(level.positions.size() + 1, 0);
  for (const Triangle& t : level.triangles) {
    for (const std::uint32_t v : t) ++at.first[v];
  }
  exclusive_scan(at.first);
  at.list.resize(level.triangles.size() * 3);
  std::vector<std::uint32_t> next(at.first.begin(), at.first.end() - 1);
  for (std::uint32_t t = 0; t < level.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) at.list[next[level.triangles[t][k]]++] = 3 * t + k;
  }
  return at;
}

std::vector<Vec3d> solve_displacements(const spatial::Surface& level, const Correspondences& correspondences,
                                       const CornersAt& around, std::span<const std::uint8_t> no_move, double damping,
                                       const Task& task) {
  const std::size_t n = level.positions.size();
  std::vector<Element> elements(level.triangles.size());
  parallel_for(elements.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& v = level.triangles[t];
      if (no_move[v[0]] == 0 || no_move[v[1]] == 0 || no_move[v[2]] == 0)
        elements[t] = element_of(level, correspondences, t);
    }
  });
  const auto for_vertices = [&](auto&& body) {
    parallel_for(n, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t v = begin; v < end; ++v) body(v);
    });
  };
  const auto product = [&](const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
    return parallel_reduce(
        n, kChunk, task, 0.0,
        [&](std::size_t begin, std::size_t end) {
          double sum = 0;
          for (std::size_t v = begin; v < end; ++v) sum += dot(a[v], b[v]);
          return sum;
        },
        [](double a1, double b1) { return a1 + b1; });
  };
  std::vector<Vec3d> moves(n), rest(n), scaled(n), direction(n), image(n);
  std::vector<double> drag(n, 0.0);
  std::vector<Sym> preconditioner(n);
  for_vertices([&](std::size_t v) {
    if (no_move[v] != 0) return;
    Sym diagonal{};
    for (std::uint32_t i = around.first[v]; i < around.first[v + 1]; ++i) {
      const Element& e = elements[around.list[i] / 3];
      const std::size_t k = around.list[i] % 3;
      for (std::size_t c = 0; c < 6; ++c) diagonal[c] += e.block[kPair[k][k]][c];
      rest[v] += e.pull[k];
      drag[v] += damping * e.weight[k];
    }
    diagonal[0] += drag[v];
    diagonal[3] += drag[v];
    diagonal[5] += drag[v];
    preconditioner[v] = inverse(diagonal);
    scaled[v] = times(preconditioner[v], rest[v]);
    direction[v] = scaled[v];
  });
  double now = product(rest, scaled);
  const double start = now;
  for (int step = 0; step < kSteps && now > kEnough * start && !task.cancelled(); ++step) {
    for_vertices([&](std::size_t v) {
      if (no_move[v] != 0) return;
      Vec3d sum = direction[v] * drag[v];
      for (std::uint32_t i = around.first[v]; i < around.first[v + 1]; ++i) {
        const std::uint32_t t = around.list[i] / 3;
        const std::size_t k = around.list[i] % 3;
        for (std::size_t l = 0; l < 3; ++l) {
          sum += times(elements[t].block[kPair[k][l]], direction[level.triangles[t][l]]);
        }
      }
      image[v] = sum;
    });
    const double curvature = product(direction, image);
    if (!(curvature > 0)) break;
    const double alpha = now / curvature;
    for_vertices([&](std::size_t v) {
      moves[v] += direction[v] * alpha;
      rest[v] -= image[v] * alpha;
      scaled[v] = times(preconditioner[v], rest[v]);
    });
    const double next = product(rest, scaled), beta = next / now;
    for_vertices([&](std::size_t v) { direction[v] = scaled[v] + direction[v] * beta; });
    now = next;
  }
  for (Vec3d& move : moves) {
    if (!is_finite(move)) move = {};
  }
  return moves;
}

namespace {

// Moves vertices, and reduces the moves until no face turns, folds or crosses another.
class Mover {
 public:
  Mover(spatial::Surface& level, const CornersAt& around, std::vector<Vec3d> moves, std::span<const Vec3d> facing,
        Vec3d offset)
      : level_(level),
        around_(around),
        moves_(std::move(moves)),
        facing_(facing),
        offset_(offset),
        neighbors_(spatial::triangle_neighbors(level)),
        before_(level.positions) {
    for (std::size_t t = 0; t < level_.triangles.size(); ++t) old_normals_.push_back(normal_of(t));
  }

  void settle(const Task& task) {
    constexpr int kHalvings = 5;
    const std::size_t n = level_.triangles.size();
    std::vector<Vec3d> normals(n);
    std::vector<std::uint8_t> bad(n);
    for (int round = 0; !task.cancelled(); ++round) {  // ends: from the last halving on, moves only vanish
      place(task);
      parallel_for(n, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t t = begin; t < end; ++t) normals[t] = normal_of(t);
      });
      parallel_for(n, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t t = begin; t < end; ++t) bad[t] = is_bad(t, normals) ? 1 : 0;
      });
      bool any = false;
      for (std::size_t v = 0; v < moves_.size(); ++v) {
        bool halve = false;
        for (std::uint32_t i = around_.first[v]; i < around_.first[v + 1] && !halve; ++i)
          halve = bad[around_.list[i] / 3] != 0;
        if (!halve || moves_[v] == Vec3d{}) continue;
        moves_[v] = round < kHalvings ? moves_[v] * 0.5 : Vec3d{};
        any = true;
      }
      if (!any) return;
    }
  }

  // Takes moves back where triangles have come to cross. False when there was nothing to take back.
  bool uncross(const Task& task) {
    std::vector<std::uint8_t> moved(level_.triangles.size(), 0);
    for (std::size_t t = 0; t < moved.size(); ++t) {
      const Triangle& v = level_.triangles[t];
      moved[t] = moves_[v[0]] != Vec3d{} || moves_[v[1]] != Vec3d{} || moves_[v[2]] != Vec3d{} ? 1 : 0;
    }
    const auto now = spatial::self_intersections(spatial::Bvh(level_, task), moved, task);
    if (now.empty() || task.cancelled()) return false;
    spatial::Surface old = level_;
    old.positions = before_;
    std::vector<std::uint8_t> suspect(moved.size(), 0);
    for (const auto& [t, u] : now) suspect[t] = suspect[u] = 1;
    const auto then = spatial::self_intersections(spatial::Bvh(old, task), suspect, task);
    bool any = false;
    for (const auto& pair : now) {
      if (std::binary_search(then.begin(), then.end(), pair)) continue;
      for (const std::uint32_t t : pair) {
        for (const std::uint32_t v : level_.triangles[t]) {
          any = any || moves_[v] != Vec3d{};
          moves_[v] = {};
        }
      }
    }
    return any;
  }

 private:
  Vec3d normal_of(std::size_t t) const {
    const auto [a, b, c] = level_.corners(t);
    return scaled_normal(a, b, c);
  }

  void place(const Task& task) {
    parallel_for(level_.positions.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t v = begin; v < end; ++v) {
        if (moves_[v] != Vec3d{})
          level_.positions[v] = to_double(to_float(before_[v] + moves_[v] - offset_)) + offset_;
        else
          level_.positions[v] = before_[v];
      }
    });
  }

  bool is_bad(std::size_t t, const std::vector<Vec3d>& normals) const {
    if (turns(old_normals_[t], normals[t])) return true;
    if (turns(facing_[t], normals[t]) && !turns(facing_[t], old_normals_[t])) return true;
    for (const std::uint32_t other : neighbors_[t]) {
      if (other == kNone) continue;
      const double now = dot(normalized(normals[t]), normalized(normals[other]));
      if (now < kFold && now < dot(normalized(old_normals_[t]), normalized(old_normals_[other]))) {
        return true;
      }
    }
    return false;
  }

  spatial::Surface& level_;
  const CornersAt& around_;
  std::vector<Vec3d> moves_;
  std::span<const Vec3d> facing_;
  Vec3d offset_;
  std::vector<std::array<std::uint32_t, 3>> neighbors_;
  std::vector<Vec3d> before_;
  std::vector<Vec3d> old_normals_;
};

}  // namespace

void apply_displacements(spatial::Surface& level, const CornersAt& around, std::vector<Vec3d> moves,
                         std::span<const Vec3d> facing, Vec3d offset, const Task& task) {
  Mover mover(level, around, std::move(moves), facing, offset);
  mover.settle(task);
  while (mover.uncross(task)) mover.settle(task);  // ends: each time moves have vanished
}

}  // namespace lodestone::simplify::detail
