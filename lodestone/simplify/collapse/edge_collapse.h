// Edge collapse: the engine that ladders of surfaces are made with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/collapse_log.h"
#include "lodestone/core/input.h"
#include "lodestone/core/mesh.h"
#include "lodestone/math/mat.h"

namespace lodestone::simplify {

/// What attributes count when edges are chosen, each a multiple of its default; 0 = they follow without a say. By
/// default a texture that slides over the surface counts like a displacement of 0.3 times as much, the whole range of a
/// colour or a number like a displacement of 1 % of the diagonal (`color` is alpha of [lod-survey]), a normal
/// that turns by one radian like 0.2 % of it, and a displacement of a morph target like any other.
struct AttributeWeights {
  float normal = 1, uv = 1, color = 1, morph = 1, generic = 1;
  std::vector<std::pair<std::string, float>> by_name;  ///< streams by name, before the above
};

struct EdgeCollapseOptions {
  std::size_t target_triangles = 0;  ///< stop at or below this count; 0 = no target
  double max_error =
      std::numeric_limits<double>::infinity();  ///< stop before an estimated error above this, units of `metric`
  bool keep_border = false;                     ///< no vertex of an open border moves or vanishes
  std::vector<std::uint8_t> no_move;            ///< one a vertex, non-zero = neither moves nor vanishes; empty = none
  /// Importance of each vertex, 0 or more: an edge costs as many times as much as its more important end says, so that
  /// w keeps triangles as if squared errors counted w-fold. A merged vertex keeps the larger. Empty = 1 everywhere.
  std::vector<float> weights;
  AttributeWeights attribute_weights;
  /// Linear map from mesh space to the space where costs and errors are judged: a mesh that is drawn stretched must be
  /// simplified as it is seen. Its translation is ignored; a singular one counts as identity.
  Mat4d metric;
  /// No collapse may leave two triangles at an edge whose dihedral angle is below the angle of this cosine where there
  /// was none (beta of [progressive-mesh], section 3.2); 1 = any fold is allowed. 10 degrees. Once no other collapse
  /// is left anywhere, angles down to 0.1 degrees are allowed: thin bars end in blades.
  float fold_cosine = 0.98481F;
  bool record_log = false;         ///< fill EdgeCollapseResult::log
  Input input = Input::unchecked;  ///< of the mesh
};

enum class StopReason { reached_target, error_limit, no_legal_collapse };
/// "reached_target", "error_limit", "no_legal_collapse".
const char* to_string(StopReason reason);

/// Vertices left that could not move, by cause.
struct LockCounts {
  std::size_t border = 0;       ///< by keep_border
  std::size_t seam_corner = 0;  ///< where seams, borders or materials meet or end
  std::size_t non_manifold = 0;
  std::size_t by_request = 0;
};

struct EdgeCollapseResult {
  Mesh mesh;
  std::vector<std::uint32_t> origin;         ///< for each output triangle, the input triangle that it descends from
  std::vector<std::uint32_t> vertex_origin;  ///< for each output vertex, the input vertex that others collapsed into
  /// How far the surface is from the input, about, or what errors of attributes count, whichever is larger; units of
  /// `metric`. The measured error comes from `measure`.
  double estimated_error = 0;
  StopReason stop = StopReason::no_legal_collapse;
  LockCounts locked;
  std::optional<CollapseLog> log;  ///< with record_log
};

/// Collapses edges until a target holds. Lindstrom & Turk 1998 (memoryless, volume-preserving placement) in passes over
/// flat arrays; see docs/papers/edge-collapse.md. Closed manifold input gives closed manifold output. Same bytes for
/// any number of threads. Time O(n log n). Positions and errors in model units. Errors: bad_argument (neither target
/// set, wrong size of `no_move` or `weights`, a weight below 0 or not finite, a metric that is not finite; those of
/// validate()), cancelled.
Result<EdgeCollapseResult> collapse_edges(const Mesh& mesh, const EdgeCollapseOptions& options = {}, Task task = {});

}  // namespace lodestone::simplify
