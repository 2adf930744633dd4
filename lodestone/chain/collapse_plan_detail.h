// CollapsePlan: one edge-collapse run on every mesh of a model, merged into one order, from which any level can be cut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/influence.h"
#include "lodestone/core/collapse_log.h"
#include "lodestone/core/model.h"
#include "lodestone/simplify/edge_collapse.h"

namespace lodestone::chain::detail {

class CollapsePlan {
 public:
  /// Collapses every drawn mesh as far as `smallest` drawn triangles may need (1 = as far as it goes). `original` must
  /// outlive the plan. Errors: empty, cancelled.
  static Result<CollapsePlan> create(const Model& original, std::size_t smallest, const Influence& influence,
                                     Task task);

  /// Number of merged collapses.
  std::size_t size() const { return mesh_of_step_.size(); }
  /// Drawn triangles after the first `count` merged collapses. O(1).
  std::size_t triangles_after(std::size_t count) const { return drawn_after_[count]; }
  /// The shortest prefix that draws at most `triangles`; size() if none does. O(log n).
  std::size_t prefix_for(std::size_t triangles) const;
  /// The model after a prefix; documents, instances and materials shared with the original. O(model).
  Result<Model> model_after(std::size_t count, Task task) const;

  const simplify::LockCounts& locked() const { return locked_; }
  /// Why the plan ends where it ends, in plain words.
  std::string why_it_ends() const;

 private:
  const Mesh& mesh(std::size_t m) const { return welded_.empty() ? original_->meshes[m] : welded_[m]; }

  const Model* original_ = nullptr;
  std::vector<Mesh> welded_;                 // the meshes that the logs are about, where they are not the original's
  std::vector<CollapseLog> logs_;            // one a mesh; empty for a mesh that is not drawn
  std::vector<std::uint32_t> mesh_of_step_;  // whose next collapse each merged step is
  std::vector<std::size_t> drawn_after_;     // size() + 1 entries, never rising
  simplify::LockCounts locked_;
};

}  // namespace lodestone::chain::detail
