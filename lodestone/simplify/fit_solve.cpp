// Method   Gauss-Newton on distances along the ties, block-Jacobi preconditioned conjugate gradients
// Cost     O(ties + steps * triangles)
#include <algorithm>
#include <array>
#include <cmath>

#include "lodestone/base/parallel.h"
#include "lodestone/math/triangle.h"
#include "lodestone/simplify/fit_solve_detail.h"
#include "lodestone/spatial/neighbors.h"

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

Element element_of(const spatial::Surface& level, const Ties& ties, std::size_t t) {
  Element e;
  const std::array<Vec3d, 3> corners = level.corners(t);
  const Vec3d normal = normalized(scaled_normal(corners[0], corners[1], corners[2]));
  for (std::uint32_t i = ties.first[t]; i < ties.first[t + 1]; ++i) {
    const Tie& tie = ties.list[i];
    const double s = static_cast<double>(tie.second), r = static_cast<double>(tie.third);
    const double w[3] = {1 - s - r, s, r};
    const Vec3d to = tie.partner - tie.on(corners);
    const double d = length(to), weight = static_cast<double>(tie.weight);
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

std::vector<Vec3d> solve_moves(const spatial::Surface& level, const Ties& ties, const CornersAt& around,
                               std::span<const std::uint8_t> held, double damping, const Task& task) {
  const std::size_t n = level.positions.size();
  std::vector<Element> elements(level.triangles.size());
  parallel_for(elements.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& v = level.triangles[t];
      if (held[v[0]] == 0 || held[v[1]] == 0 || held[v[2]] == 0) elements[t] = element_of(level, ties, t);
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
    if (held[v] != 0) return;
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
      if (held[v] != 0) return;
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

void take_moves(spatial::Surface& level, const CornersAt& around, std::vector<Vec3d> moves,
                std::span<const Vec3d> facing, Vec3d offset, const Task& task) {
  constexpr int kHalvings = 5;
  const std::vector<std::array<std::uint32_t, 3>> neighbors = spatial::triangle_neighbors(level);
  const std::vector<Vec3d> before = level.positions;
  const std::size_t n = level.triangles.size();
  std::vector<Vec3d> old_normals(n), normals(n);
  const auto normal_of = [&](std::size_t t) {
    const auto [a, b, c] = level.corners(t);
    return scaled_normal(a, b, c);
  };
  for (std::size_t t = 0; t < n; ++t) old_normals[t] = normal_of(t);
  std::vector<std::uint8_t> bad(n);
  for (int round = 0; !task.cancelled(); ++round) {  // ends: from the last halving on, moves only vanish
    parallel_for(level.positions.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t v = begin; v < end; ++v) {
        if (moves[v] != Vec3d{})
          level.positions[v] = to_double(to_float(before[v] + moves[v] - offset)) + offset;
        else
          level.positions[v] = before[v];
      }
    });
    parallel_for(n, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t t = begin; t < end; ++t) normals[t] = normal_of(t);
    });
    parallel_for(n, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t t = begin; t < end; ++t) {
        bad[t] =
            turns(old_normals[t], normals[t]) || (turns(facing[t], normals[t]) && !turns(facing[t], old_normals[t]))
                ? 1
                : 0;
        for (const std::uint32_t other : neighbors[t]) {
          if (bad[t] != 0 || other == kNone) continue;
          const double lengths = length(normals[t]) * length(normals[other]);
          const double old_lengths = length(old_normals[t]) * length(old_normals[other]);
          bad[t] = dot(normals[t], normals[other]) < kFold * lengths &&
                           !(dot(old_normals[t], old_normals[other]) < kFold * old_lengths)
                       ? 1
                       : 0;
        }
      }
    });
    bool any = false;
    for (std::size_t v = 0; v < moves.size(); ++v) {
      bool halve = false;
      for (std::uint32_t i = around.first[v]; i < around.first[v + 1] && !halve; ++i)
        halve = bad[around.list[i] / 3] != 0;
      if (!halve || moves[v] == Vec3d{}) continue;
      moves[v] = round < kHalvings ? moves[v] * 0.5 : Vec3d{};
      any = true;
    }
    if (!any) return;
  }
}

}  // namespace lodestone::simplify::detail
