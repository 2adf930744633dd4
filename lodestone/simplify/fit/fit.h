// Fitting: vertices of a level moved to where it is nearest to its original, and edges turned over.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/simplify/fit/target.h"

namespace lodestone::simplify {

struct FitOptions {
  int solves = 6;                    ///< how often vertices are moved and all partners found again
  bool flips = true;                 ///< turn edges over, too; not where textures or colours would change their course
  bool volume = false;               ///< in the end all vertices go in or out until the original's volume is met
  std::vector<std::uint8_t> locked;  ///< one a vertex of the level, non-zero = stays; empty = none
};

/// A level with what is known of its distance from its target: judged at the target's points and at points of the
/// level, the worst places looked at closely. An estimate: the figure to tell comes from `measure`.
class FittedLevel {
 public:
  /// The largest distance found at a triangle: where on it (weights of its second and third corner), and the point of
  /// the original there.
  struct Worst {
    double distance = 0, second = 0, third = 0;
    Vec3d partner;
  };

  /// Measures a level. Where it has triangles in common with one that is known, only what the others change is measured
  /// anew. O(n log n). The target must outlive it.
  FittedLevel(const FitTarget& target, Mesh level, const Task& task, const FittedLevel* known = nullptr);
  FittedLevel(const FittedLevel& other);
  FittedLevel& operator=(const FittedLevel& other);
  FittedLevel(FittedLevel&&) noexcept;
  FittedLevel& operator=(FittedLevel&&) noexcept;
  ~FittedLevel();

  const FitTarget& target() const;
  const Mesh& mesh() const;
  double mean() const;  ///< of both directions, mesh units
  double max() const;
  std::vector<Worst> worst() const;  ///< one a triangle of the mesh

  /// Looks at a place (mesh space) on the original, or on the level: worst() and max() rise where it is farther than
  /// was known. What is found stays while its triangle does. O(triangles).
  void look_at(Vec3d place, bool on_original, const Task& task);

  /// What is wrong with a level whatever its distance: pairs of triangles that cross, edges where two triangles lie on
  /// each other (an angle of more than 170 degrees between their normals). O(n log n).
  struct Faults {
    std::size_t crossings = 0, folds = 0;
    std::vector<std::uint8_t> vertices;  ///< of the mesh: non-zero at faulty triangles
    bool no_more_than(const Faults& other) const { return crossings <= other.crossings && folds <= other.folds; }
  };
  Faults faults(const Task& task) const;

  /// The triangles that are measured, in mesh space.
  const spatial::Surface& surface() const;

  /// Moves vertices; borders, seams, borders of materials, and what is not manifold stay. Source: Hoppe et al., "Mesh
  /// optimization", SIGGRAPH 1993, with distances both ways. Stops early where nothing is gained, so the mean square is
  /// never above the start's; but where the volume is to be met, which costs a little. O(solves * n log n); where much
  /// is locked, only what moves is measured again.
  void fit(const FitOptions& options, const Task& task);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lodestone::simplify
