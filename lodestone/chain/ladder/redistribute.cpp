// One round of redistributing triangles (docs/papers/measured-feedback.md, "Redistributing triangles").
//
// redistribute_triangles(): the worst triangles are split (split_worst()). Edges are collapsed down to the count, with
// weights that make vertices near bad places and on borders the last to go (weights_for(), weight_borders()). What lies
// within kRings of anything new is fitted and measured again (TrackedLevel); all else is known from the level before.
// What must not move, collapse or be split is looked up by the vertices' names (of_original(), still_held()).
//
// The same bytes for any number of threads. O(n log n) for the collapse and the trees; only what changed is measured.
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
constexpr double kWorstWeight = 1e4;   // weight of vertices where the level is worst
constexpr int kLocalSolves = 2;
constexpr float kNoCollapseWeight = 1e8F;  // weight of no_collapse and no_move vertices
constexpr int kRings = 2;                  // around what is new: vertices that are fitted again

// Non-zero for vertices that are where the vertex that they come from was.
std::vector<std::uint8_t> unmoved(const Mesh& mesh, const std::vector<std::uint32_t>& vertex_origin,
                                  const Mesh& before) {
  std::vector<std::uint8_t> out(mesh.vertex_count(), 0);
  for (std::size_t v = 0; v < out.size(); ++v) {
    const std::uint32_t was = vertex_origin[v];
    out[v] = was < before.vertex_count() && mesh.positions[v] == before.positions[was] ? 1 : 0;
  }
  return out;
}

// Non-zero for vertices more than `rings` edges away from all new ones. `far`: non-zero for those that are not new.
std::vector<std::uint8_t> far_from_new(const Mesh& mesh, std::vector<std::uint8_t> far, int rings) {
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

// Weights of the vertices of a level some of whose triangles have been split: heavier the farther from the original.
std::vector<float> weights_for(const TrackedLevel& level, const Mesh& split, const std::vector<std::uint32_t>& names,
                               const RedistributeOptions& options) {
  std::vector<float> weights(split.vertex_count(), 1.0F);
  const std::vector<simplify::TriangleError> worst = level.worst();
  for (std::size_t t = 0; t < split.triangles.size(); ++t) {
    const double share = t < worst.size() && level.max() > 0 ? worst[t].distance / level.max() : 1;
    const auto weight = static_cast<float>(1 + kWorstWeight * share * share * share * share);
    for (const std::uint32_t v : split.vertices_of(t)) weights[v] = std::max(weights[v], weight);
  }
  for (const std::vector<HeldVertex>* list : {&options.no_collapse, &options.no_move}) {
    const std::vector<std::uint8_t> left = still_held(split, names, *list);
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

std::vector<std::uint32_t> names_after(const std::vector<std::uint32_t>& names,
                                       const std::vector<std::uint32_t>& vertex_origin) {
  std::vector<std::uint32_t> out;
  out.reserve(vertex_origin.size());
  for (const std::uint32_t v : vertex_origin) out.push_back(names[v]);
  return out;
}

std::vector<std::uint8_t> of_original(const std::vector<std::uint32_t>& names, const std::vector<std::uint8_t>& list) {
  std::vector<std::uint8_t> out(names.size(), 0);
  for (std::size_t v = 0; v < out.size(); ++v) out[v] = names[v] < list.size() ? list[names[v]] : std::uint8_t{0};
  return out;
}

std::vector<std::uint8_t> still_held(const Mesh& mesh, const std::vector<std::uint32_t>& names,
                                     const std::vector<HeldVertex>& list) {
  std::vector<std::uint8_t> out(names.size(), 0);
  const auto by_name = [](const HeldVertex& held, std::uint32_t name) { return held.name < name; };
  for (std::size_t v = 0; v < out.size(); ++v) {
    auto held = std::lower_bound(list.begin(), list.end(), names[v], by_name);
    for (; held != list.end() && held->name == names[v]; ++held) {
      if (held->position == mesh.positions[v]) out[v] = 1;
    }
  }
  return out;
}

Result<NamedLevel> redistribute_triangles(const FeedbackSource& source, const NamedLevel& level,
                                          const RedistributeOptions& options, std::uint32_t& next_name,
                                          const Task& task) {
  const Mesh& before = level.level.mesh();
  const std::vector<std::uint8_t>& locked = source.options.no_move;  // of the original's vertices
  simplify::SplitResult split;
  if (options.fits) {
    simplify::SplitOptions splitting;
    splitting.share = kSplit;
    splitting.most =
        std::max<std::size_t>(2, static_cast<std::size_t>(kSplitShare * static_cast<double>(before.triangles.size())));
    splitting.keep_borders = source.options.keep_border;
    splitting.no_move = of_original(level.names, locked);
    splitting.no_split = still_held(before, level.names, options.no_move);
    split = simplify::split_worst(level.level, splitting, task);
  } else {
    split.mesh = before;
  }
  std::vector<std::uint32_t> names = level.names;
  while (names.size() < split.mesh.vertex_count()) names.push_back(next_name++);
  EdgeCollapseOptions collapse = source.options;
  collapse.target_triangles = options.most_triangles;
  collapse.record_log = false;
  collapse.no_move = of_original(names, locked);
  collapse.weights = weights_for(level.level, split.mesh, names, options);
  if (options.keeps_borders) weight_borders(split.mesh, kNoCollapseWeight, collapse.weights, task);
  Result<simplify::EdgeCollapseResult> made = simplify::collapse_edges(split.mesh, collapse, task);
  LODESTONE_TRY(made);
  const std::vector<std::uint32_t>& origin = made->vertex_origin;
  simplify::FitOptions fit;
  fit.solves = options.fits ? kLocalSolves : 0;
  fit.no_move = far_from_new(made->mesh, unmoved(made->mesh, origin, before), kRings);
  std::vector<std::uint8_t> pulled(split.mesh.vertex_count(), 0);
  for (const std::uint32_t v : split.pulled) pulled[v] = 1;
  const std::vector<std::uint8_t> still = unmoved(made->mesh, origin, split.mesh);
  NamedLevel next{TrackedLevel(source.target, std::move(made->mesh), level.level, task), names_after(names, origin)};
  const std::vector<std::uint8_t> kept = of_original(next.names, locked);
  const std::vector<std::uint8_t> no_move = still_held(next.level.mesh(), next.names, options.no_move);
  for (std::size_t v = 0; v < fit.no_move.size(); ++v) {
    // Fitting would move vertices out again that were pulled in.
    if (kept[v] != 0 || no_move[v] != 0 || (pulled[origin[v]] != 0 && still[v] != 0)) fit.no_move[v] = 1;
  }
  next.level.fit(fit, task);
  return next;
}

}  // namespace lodestone::chain::detail
