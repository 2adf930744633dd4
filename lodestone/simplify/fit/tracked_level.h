// TrackedLevel: a level that knows its distance from its original. It can be fitted: its vertices are moved to where it
// is nearest to the original, and edges are turned over.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/simplify/fit/target.h"
#include "lodestone/simplify/fit/triangle_error.h"

namespace lodestone::simplify {

struct FitOptions {
  int solves = 6;                     ///< how often vertices are moved and all partners found again
  bool flips = true;                  ///< turn edges over, too; not where textures or colours would change their course
  bool volume = false;                ///< in the end all vertices go in or out until the original's volume is met
  std::vector<std::uint8_t> no_move;  ///< one a vertex of the level, non-zero = does not move; empty = none
};

/// A level with what is known of its distance from its target: judged at the target's points and at points of the
/// level, the worst places looked at closely. An estimate: the figure to tell comes from `measure`.
class TrackedLevel {
 public:
  /// Measures a level. Where it has triangles in common with one that is known, only what the others change is measured
  /// anew. O(n log n). The target must outlive it.
  TrackedLevel(const FitTarget& target, Mesh level, const Task& task);
  TrackedLevel(const FitTarget& target, Mesh level, const TrackedLevel& known, const Task& task);
  TrackedLevel(const TrackedLevel& other);
  TrackedLevel& operator=(const TrackedLevel& other);
  TrackedLevel(TrackedLevel&&) noexcept;
  TrackedLevel& operator=(TrackedLevel&&) noexcept;
  ~TrackedLevel();

  const FitTarget& target() const;
  const Mesh& mesh() const;
  double mean() const;  ///< of both directions, mesh units
  double max() const;
  std::vector<TriangleError> worst() const;  ///< one a triangle of the mesh

  /// Looks at a place (mesh space) on the original, or on the level: worst() and max() rise where it is farther than
  /// was known. What is found is known as long as the triangle exists. O(triangles).
  void probe_error(Vec3d place, bool on_original, const Task& task);

  /// What is wrong with a level whatever its distance: pairs of triangles that cross, edges where two triangles lie on
  /// each other (an angle of more than 170 degrees between their normals). O(n log n).
  struct Faults {
    std::size_t intersections = 0, folds = 0;
    std::vector<std::uint8_t> vertices;  ///< of the mesh: non-zero at faulty triangles
    bool no_more_than(const Faults& other) const {
      return intersections <= other.intersections && folds <= other.folds;
    }
  };
  Faults faults(const Task& task) const;

  /// The triangles that are measured, in mesh space.
  const spatial::Surface& surface() const;

  /// Moves vertices, except those on borders, seams, borders of materials and non-manifold edges. Source:
  /// [hoppe-1993], with distances both ways. Stops where nothing is gained, so the mean square never rises, unless the
  /// volume is to be met, which costs a little. O(solves * n log n); with no_move, only what moves is measured again.
  void fit(const FitOptions& options, const Task& task);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lodestone::simplify
