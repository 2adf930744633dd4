#include "lodestone/voxel/boolean.h"

#include "lodestone/core/validate.h"

namespace lodestone::voxel {

Result<void> combine(BitVolume& a, const BitVolume& b, BooleanOperation operation) {
  LODESTONE_TRY(validate(a));
  LODESTONE_TRY(validate(b));
  if (a.grid.size != b.grid.size || a.grid.origin != b.grid.origin || a.grid.spacing != b.grid.spacing) {
    return fail(ErrorCode::bad_argument, "the solids' voxels do not lie alike", {}, "voxelize both in one grid");
  }
  for (std::size_t w = 0; w < a.words.size(); ++w) {
    switch (operation) {
      case BooleanOperation::unite:
        a.words[w] |= b.words[w];
        break;
      case BooleanOperation::intersect:
        a.words[w] &= b.words[w];
        break;
      case BooleanOperation::subtract:
        a.words[w] &= ~b.words[w];
        break;
    }
  }
  return {};
}

}  // namespace lodestone::voxel
