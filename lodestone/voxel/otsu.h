// Otsu's threshold: the value that separates two classes of values best.
#pragma once

#include "lodestone/core/scanned_volume.h"

namespace lodestone::voxel {

/// The value that best parts values in two [otsu-1979], by 1024 bins between least and most. O(values).
double otsu_threshold(const VolumeValues& values, double least, double most);

}  // namespace lodestone::voxel
