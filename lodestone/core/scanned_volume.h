// A volume as a scanner or a file gives it: values, and where they lie in the world.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "lodestone/core/volume.h"
#include "lodestone/math/mat.h"

namespace lodestone {

/// All about a volume but its values.
struct VolumeHeader {
  VoxelGrid grid;  ///< in the volume's own frame: the first voxel's centre is at (0, 0, 0)
  Mat4d to_world;  ///< the volume's own frame to the world; columns need not be at right angles (gantry tilt)
  bool patient_axes = false;   ///< world axes are a patient's: x left, y posterior, z superior (LPS), millimetres
  double meters_per_unit = 0;  ///< 0.001 for millimetres; 0 = the file doesn't say
  /// Where the slices lie along the volume's z where they are not evenly spaced, one value a slice, rising; else empty.
  std::vector<double> slice_positions;
  std::vector<std::filesystem::path> files;
  std::vector<std::string> warnings;
};

/// Values in the type that holds all of them, x fastest.
using VolumeValues = std::variant<std::span<const std::uint8_t>, std::span<const std::int16_t>,
                                  std::span<const std::uint16_t>, std::span<const float>>;

struct ScannedVolume {
  VolumeHeader header;
  VolumeValues values;
  std::shared_ptr<const void> storage;  ///< keeps the values: memory, or a mapped file
};

}  // namespace lodestone
