// Labels of a segmented volume: where each lies, and a mask of it.
#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/core/volume.h"

namespace lodestone::voxel {

/// The voxels that a label lies between, `low` and `high` included.
struct LabelBox {
  std::array<std::uint32_t, 3> low{kNone, kNone, kNone}, high{};
};

/// The box of each label but 0, by number, in one pass. `T` is one of the value types of a ScannedVolume. Errors:
/// bad_argument (values that are no whole numbers or above 1e9, more than 4096 labels, values that look like grey ones:
/// more than 32, and most neighbours differ by a little), cancelled. O(voxels log labels).
template <class T>
Result<std::map<std::int64_t, LabelBox>> label_boxes(const VolumeView<T>& volume, const Task& task);

/// One label as a volume of its own: 255 where it is. O(voxels of the box).
template <class T>
ScalarVolume<std::uint8_t> label_mask(const VolumeView<T>& volume, const LabelBox& box, std::int64_t label);

}  // namespace lodestone::voxel
