// Blending attribute tuples, each stream by its meaning.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/core/mesh.h"

namespace lodestone {

/// Moves tuples of a mesh's streams towards each other in place. Made once for a mesh whose streams it may change.
class AttributeBlender {
 public:
  explicit AttributeBlender(std::vector<AttributeStream>& streams);

  /// Tuple `to` becomes (1 - t) of itself and t of tuple `from`, t in [0, 1]. Normals and tangents stay unit where they
  /// can; what is picked comes from the nearer one; skin influences merge as (joint, weight) pairs, the heaviest kept,
  /// their sum as before.
  void blend(std::uint32_t to, std::uint32_t from, float t);

 private:
  struct SkinSet {
    std::size_t joints, weights;  // stream indices
  };
  void blend_skin(std::uint32_t to, std::uint32_t from, float t);

  std::vector<AttributeStream>& streams_;
  std::vector<SkinSet> skin_;
  std::vector<std::size_t> plain_;                           // all streams that are not part of a skin set
  std::vector<std::pair<std::uint32_t, float>> influences_;  // scratch
};

}  // namespace lodestone
