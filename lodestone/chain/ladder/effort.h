// How much work a level is worth.
#pragma once

namespace lodestone::chain {

/// What each buys and costs, over fourteen models at a tenth of their triangles: docs/papers/measured-feedback.md.
enum class Effort {
  fast,    ///< edge collapse alone
  normal,  ///< weighted: collapsed again, with weights where the measured error is largest; a smaller maximum
  best     ///< fitted: vertices moved, edges turned, triangles shifted; 0.85 of the mean, 0.8 of the maximum
};

}  // namespace lodestone::chain
