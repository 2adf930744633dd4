// Surfaces of scanned volumes as models: at one value, or one for each label.
#pragma once

#include <optional>
#include <string>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"
#include "lodestone/core/scanned_volume.h"

namespace lodestone::chain {

struct VolumeSurfaceOptions {
  std::optional<double> iso;  ///< what is above is inside; without: Otsu's threshold, with a warning that names it
  bool labels = false;        ///< values are labels: a mesh for each whole number but 0, named "label N"
  double smooth = 0;  ///< blurs the values before contouring: standard deviation in voxels or millimetres; 0 = not
  bool smooth_in_voxels = true;
  bool trilinear = false;  ///< with `iso`: the topology of the trilinear interpolant, see voxel::IsosurfaceOptions
  bool median = false;     ///< takes the median of 3 x 3 x 3 values first, against speckles
};

struct VolumeSurface {
  Model model;  ///< world space: a patient's axes (LPS) and millimetres where the file says so
  double iso = 0;
  double least = 0, most = 0;  ///< values of the volume
};

/// The surface at native resolution, closed where the volume ends. Errors: bad_argument (iso outside of the values: the
/// error says their range; labels that aren't whole numbers, are more than 4096, or look like grey values; those of
/// validate()), bad_format (no value is a number), empty (nothing above), cancelled.
Result<VolumeSurface> surface_of(const ScannedVolume& volume, const VolumeSurfaceOptions& options = {}, Task task = {});

}  // namespace lodestone::chain
