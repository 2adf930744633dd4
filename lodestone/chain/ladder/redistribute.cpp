// Method   worst triangles split, others collapsed, what is new fitted and measured
// Source   docs/papers/measured-feedback.md
#include "lodestone/chain/ladder/redistribute_detail.h"

#include <algorithm>

#include "lodestone/core/adjacency.h"
#include "lodestone/simplify/fit/split_worst.h"

namespace lodestone::chain::detail {

using simplify::EdgeCollapseOptions;
using simplify::TrackedLevel;

namespace {

constexpr double kSplit = 0.75;        // of the maximum: triangles above it are split
constexpr double kSplitShare = 0.004;  // of all triangles that may be added a round
constexpr double kWorstWeight = 1e4;   // weight of vertices where the level is worst, so that they stay
constexpr int kLocalSolves = 2;
constexpr float kNoCollapseWeight = 1e8F;  // weight of vertices to leave
constexpr int kRings = 2;                  // around what is new: vertices that are fitted again

// Vertices farther than `rings` edges from those that are new to a mesh.
std::vector<std::uint8_t> far_from_new(const Mesh& mesh, const Mesh& old, int rings) {
  std::vector<Vec3f> known = old.positions;
  std::sort(known.begin(), known.end(), before);
  std::vector<std::uint8_t> far = at_positions(mesh, known);
  for (int ring = 0; ring < rings; ++ring) {
    const std::vector<std::uint8_t> last = far;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle v = mesh.vertices_of(t);
      if (last[v[0]] != 0 && last[v[1]] != 0 && last[v[2]] != 0) continue;
      for (const std::uint32_t x : v) far[x] = 0;
    }
  }
  return far;
}

// Of vertices of a level, some of whose triangles have been split: the farther from the original, the heavier.
std::vector<float> weights_for(const TrackedLevel& level, const Mesh& split, const RedistributeOptions& options) {
  std::vector<float> weights(split.vertex_count(), 1.0F);
  const std::vector<simplify::TriangleError> worst = level.worst();
  for (std::size_t t = 0; t < split.triangles.size(); ++t) {
    const double share = t < worst.size() && level.max() > 0 ? worst[t].distance / level.max() : 1;
    const auto weight = static_cast<float>(1 + kWorstWeight * share * share * share * share);
    for (const std::uint32_t v : split.vertices_of(t)) weights[v] = std::max(weights[v], weight);
  }
  for (const std::vector<Vec3f>* positions : {&options.no_collapse, &options.no_move}) {
    const std::vector<std::uint8_t> left = at_positions(split, *positions);
    for (std::size_t v = 0; v < left.size(); ++v) {
      if (left[v] != 0) weights[v] = std::max(weights[v], kNoCollapseWeight);
    }
  }
  return weights;
}

}  // namespace

void weight_borders(const Mesh& mesh, float weight, std::vector<float>& weights, const Task& task) {
  const EdgeTriangles edges = edge_triangles(mesh, task);
  for (const Edge& edge : edges.edges) {
    if (edge.count != 1) continue;
    for (const std::uint32_t v : {edge.a, edge.b}) weights[v] = std::max(weights[v], weight);
  }
}

std::vector<std::uint8_t> at_positions(const Mesh& mesh, const std::vector<Vec3f>& positions) {
  std::vector<std::uint8_t> found(mesh.vertex_count(), 0);
  for (std::size_t v = 0; v < found.size(); ++v) {
    found[v] = std::binary_search(positions.begin(), positions.end(), mesh.positions[v], before) ? 1 : 0;
  }
  return found;
}

Result<TrackedLevel> redistribute_triangles(const FeedbackSource& source, const TrackedLevel& level,
                                            const RedistributeOptions& options, const Task& task) {
  simplify::SplitResult split;
  if (options.fits) {
    const auto share = static_cast<std::size_t>(kSplitShare * static_cast<double>(level.mesh().triangles.size()));
    split = simplify::split_worst(level, kSplit, std::max<std::size_t>(2, share), source.options.keep_border,
                                  at_positions(level.mesh(), source.no_move_positions),
                                  at_positions(level.mesh(), options.no_move), task);
    std::sort(split.pulled.begin(), split.pulled.end(), before);
  } else {
    split.mesh = level.mesh();
  }
  EdgeCollapseOptions collapse = source.options;
  collapse.target_triangles = options.most_triangles;
  collapse.record_log = false;
  collapse.no_move = at_positions(split.mesh, source.no_move_positions);
  collapse.weights = weights_for(level, split.mesh, options);
  if (options.keeps_borders) weight_borders(split.mesh, kNoCollapseWeight, collapse.weights, task);
  Result<simplify::EdgeCollapseResult> made = simplify::collapse_edges(split.mesh, collapse, task);
  LODESTONE_TRY(made);
  TrackedLevel next(source.target, std::move(made->mesh), task, &level);
  simplify::FitOptions fit;
  fit.solves = options.fits ? kLocalSolves : 0;
  fit.no_move = far_from_new(next.mesh(), level.mesh(), kRings);
  const std::vector<std::uint8_t> kept = at_positions(next.mesh(), source.no_move_positions);
  const std::vector<std::uint8_t> pulled = at_positions(next.mesh(), split.pulled);
  const std::vector<std::uint8_t> no_move = at_positions(next.mesh(), options.no_move);
  for (std::size_t v = 0; v < fit.no_move.size(); ++v) {
    if (kept[v] != 0 || pulled[v] != 0 || no_move[v] != 0)
      fit.no_move[v] = 1;  // fitting would let those out again that were pulled in
  }
  next.fit(fit, task);
  return next;
}

}  // namespace lodestone::chain::detail
