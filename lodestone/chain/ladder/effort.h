// How much work a level is worth.
#pragma once

namespace lodestone::chain {

/// What each buys and costs, over fourteen models at a tenth of their triangles: docs/papers/measured-feedback.md.
enum class Effort {
  fast,    ///< edge collapse alone
  normal,  ///< and again with weights where the level's measured error is largest: a smaller maximum
  best  ///< vertices moved, edges turned, triangles shifted by measured distances: 0.85 of the mean, 0.8 of the maximum
};

}  // namespace lodestone::chain
