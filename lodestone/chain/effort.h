// How much work a level is worth.
#pragma once

namespace lodestone::chain {

enum class Effort {
  fast,    ///< edge collapse alone
  normal,  ///< and again with weights where the level's measured error is largest: less than half the maximum
  best     ///< more rounds, vertices moved and edges turned by measured distances: less of both mean and maximum
};

}  // namespace lodestone::chain
