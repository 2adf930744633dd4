// The samples that are no meshes: a CT volume and a scan's points, as bytes of a file. The same on every machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "lodestone/base/task.h"

namespace lodestone::app {

/// A knee as a CT scanner sees it: 96 x 96 x 80 voxels of 1.2 x 1.2 x 1.5 mm, Hounsfield units as int16 (air -1000, fat
/// -100, muscle 50, bone from 450), in the patient's axes, as NRRD. Below 0 lies the skin, at 300 four bones.
struct CtSample {
  std::array<std::size_t, 3> size{};
  std::string nrrd;
};
CtSample make_ct(std::uint64_t seed, const Task& task);

/// The statue as a scanner leaves it: points with normals and colours, a tenth of a millimetre rough, in metres, and
/// none below the plinth, as binary PLY.
struct ScanSample {
  std::size_t points = 0;
  std::string ply;
};
ScanSample make_scan(std::size_t points, std::uint64_t seed, const Task& task);

}  // namespace lodestone::app
