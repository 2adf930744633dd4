// CollapseLog: an edge-collapse run as a flat record. Any prefix can be replayed, and every step undone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/input.h"
#include "lodestone/core/mesh.h"

namespace lodestone {

/// One collapse: vertex `removed` merges into `kept`, which moves to `position`. 44 bytes.
struct Collapse {
  std::uint32_t kept = 0, removed = 0;  ///< vertices of the original mesh
  Vec3f position;                       ///< of `kept` from now on, relative to Mesh::offset
  Vec3f kept_before;                    ///< of `kept` until now: what undoing needs (`removed` stays where it was)
  float error = 0;                      ///< estimated (shape and attributes), model units, never falling along the log
  std::uint32_t first_wedge = 0;        ///< start of this collapse's entries in CollapseLog::wedges (none for a mesh
                                        ///< without wedges of its own and attributes)
  std::uint32_t faces = 0;              ///< triangles that vanish with it
};

/// Attributes of wedge `kept` move towards those of `removed` by `blend`, 0 to 1. Where `ends` is set, `removed` is a
/// wedge of the removed vertex whose corners use `kept` from now on; else it only lends its values. 16 bytes.
struct WedgeMerge {
  std::uint32_t kept = 0, removed = 0;
  float blend = 0;
  bool ends = true;
};

/// Order and content depend on the input mesh and the method's options, never on the target.
struct CollapseLog {
  std::vector<Collapse> collapses;
  std::vector<WedgeMerge> wedges;
  std::uint32_t start_triangles = 0;  ///< triangles before the first collapse (degenerate and doubled ones left out)
  /// Input triangles that take no part (degenerate or doubled in the same direction), ascending.
  std::vector<std::uint32_t> dropped;

  /// Triangles left after the first `count` collapses. O(count).
  std::size_t triangles_after(std::size_t count) const;
  /// The shortest prefix that leaves at most `triangles`; all collapses if none does. O(collapses).
  std::size_t prefix_for(std::size_t triangles) const;
};

/// The mesh after a prefix.
struct ReplayResult {
  Mesh mesh;                          ///< compact: vertices and wedges in ascending order of their original index
  std::vector<std::uint32_t> origin;  ///< for each triangle, the input triangle that it descends from
  std::vector<std::uint32_t> vertex_origin;  ///< for each vertex, the input vertex that others collapsed into; rising
};

/// What else becomes of triangles. One entry an input triangle, non-zero = yes; empty = none.
struct ReplayOptions {
  std::vector<std::uint8_t> left_out;   ///< not in the result: its part has vanished
  std::vector<std::uint8_t> untouched;  ///< as it was to the bit, though degenerate or doubled; its vertices must have
                                        ///< been locked in the run
  Input input = Input::unchecked;       ///< of mesh and log
};

/// Applies the first `count` collapses of `log` to `mesh`, the mesh that the log was made from. Attributes: blended
/// ones interpolated, normals and tangents unit again, weights pruned to the sets there are and summing to one. O(mesh
/// + count). Errors: bad_argument (those of validate(), of mesh and log; a count above the log's; lists of `options`
/// with another length than the triangles), cancelled.
Result<ReplayResult> replay(const Mesh& mesh, const CollapseLog& log, std::size_t count, Task task = {});
Result<ReplayResult> replay(const Mesh& mesh, const CollapseLog& log, std::size_t count, const ReplayOptions& options,
                            Task task = {});

}  // namespace lodestone
