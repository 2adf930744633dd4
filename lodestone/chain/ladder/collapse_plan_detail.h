// CollapsePlan: one edge-collapse run on every mesh of a model, and the vanishing of thin parts where it is asked for,
// merged into one order, from which any level can be cut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/ladder/constraints.h"
#include "lodestone/chain/ladder/effort.h"
#include "lodestone/chain/ladder/feedback_detail.h"
#include "lodestone/core/collapse_log.h"
#include "lodestone/core/model.h"
#include "lodestone/measure/distance.h"
#include "lodestone/simplify/collapse/edge_collapse.h"
#include "lodestone/simplify/fit/target.h"
#include "lodestone/simplify/prune/prune_order.h"

namespace lodestone::chain::detail {

/// The originals that levels are fitted to and measured against, one a mesh, each prepared when it is first needed.
struct FitTargets {
  std::vector<std::unique_ptr<simplify::FitTarget>> targets;
  std::vector<std::optional<measure::Reference>> references;  ///< of those that are improved to a goal
};

/// Why a plan ends where it ends.
struct PlanEnd {
  std::string why;        ///< plain words
  std::size_t parts = 0;  ///< as Shortfall::parts
};

class CollapsePlan {
 public:
  /// Collapses every drawn mesh as far as `smallest` drawn triangles may need (1 = as far as it goes). `original` must
  /// outlive the plan. Errors: empty, bad_argument (the constraints does not fit the model), cancelled.
  static Result<CollapsePlan> create(const Model& original, std::size_t smallest,
                                     const SimplifyConstraints& constraints, Task task);

  /// Number of merged steps: collapses, and parts that vanish.
  std::size_t size() const { return steps_.size(); }
  /// Drawn triangles after the first `count` steps. O(1).
  std::size_t triangles_after(std::size_t count) const { return drawn_after_[count]; }
  /// Drawn parts that have vanished after the first `count` steps. O(count).
  std::size_t vanished_after(std::size_t count) const;
  /// The shortest prefix that draws at most `triangles`; size() if none does. O(log n).
  std::size_t prefix_for(std::size_t triangles) const;
  /// The model after a prefix; documents, instances and materials shared with the original. O(model).
  Result<Model> model_after(std::size_t count, Task task) const;

  /// As model_after(), with every mesh that allows it improved by its own measured error (apply_feedback()): those that
  /// are drawn without being stretched, of which no part may vanish and no triangle is untouched. `targets` is empty at
  /// first and belongs to this plan; what is prepared in it serves the next calls.
  /// `goal`: an error not to exceed, world space, with as few triangles as possible; 0 = the smallest error with the
  /// prefix's number of triangles.
  Result<Model> model_with_feedback(std::size_t count, Effort effort, double goal, FitTargets& targets,
                                    Task task) const;

  /// Whether any mesh allows it. O(triangles).
  bool can_take_feedback() const;

  /// Whether parts may vanish.
  bool prunes() const { return prunes_; }
  const simplify::LockCounts& locked() const { return locked_; }
  PlanEnd end() const;

 private:
  // The next collapse of a mesh, or its next part that vanishes: the mesh's number, and a bit.
  class Step {
   public:
    Step(std::uint32_t mesh, bool vanishes) : bits_(mesh << 1 | (vanishes ? 1U : 0U)) {}
    std::uint32_t mesh() const { return bits_ >> 1; }
    bool vanishes() const { return (bits_ & 1U) != 0; }

   private:
    std::uint32_t bits_;
  };
  // How many steps of one mesh lie in a prefix: collapses, and parts that vanish.
  struct Progress {
    std::size_t collapses = 0, steps = 0;
  };

  const Mesh& mesh(std::size_t m) const { return working_.empty() ? original_->meshes[m] : working_[m]; }
  Result<void> plan_mesh(std::size_t m, std::size_t target, const SimplifyConstraints& constraints,
                         VertexConstraints told, const Task& task);
  void merge();
  void count_triangles();
  std::size_t drawn_parts() const;
  std::vector<Progress> progress_after(std::size_t count) const;
  Result<Model> replayed(std::size_t count, std::vector<std::vector<std::uint32_t>>& vertex_origins,
                         const Task& task) const;
  Result<ReplayResult> mesh_after(std::size_t m, const Progress& progress, double error, const Task& task) const;
  void finish(Mesh& mesh) const;
  bool can_take_feedback(std::size_t m) const;
  Result<Mesh> mesh_with_feedback(std::size_t m, NamedMesh plain, Effort effort, double goal, FitTargets& targets,
                                  const Task& task) const;

  const Model* original_ = nullptr;
  std::vector<Mesh> working_;        // the meshes that the logs are about, where they are not the original's
  std::vector<Mat4d> placings_;      // one a mesh: where its errors are judged
  std::vector<std::uint32_t> uses_;  // how often each mesh is drawn
  std::vector<simplify::EdgeCollapseOptions> options_;  // one a mesh, of the run that made its log
  std::vector<CollapseLog> logs_;                       // one a mesh; empty for a mesh that is not drawn
  std::vector<simplify::PruneOrder> thin_;              // one a mesh; empty unless parts may vanish
  std::vector<std::vector<std::uint8_t>> untouched_;    // triangles of each mesh that must not change; empty = none
  std::vector<Step> steps_;
  std::vector<std::size_t> drawn_after_;  // size() + 1 entries, never rising
  simplify::LockCounts locked_;
  bool prunes_ = false, keep_area_ = false;
  std::size_t max_skin_influences_ = 0;
  Tangents tangents_ = Tangents::interpolated;
};

}  // namespace lodestone::chain::detail
