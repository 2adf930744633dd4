// How DICOM slices make a volume: by what their tags say of place, never by name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/math/vec.h"

namespace lodestone::io::detail {

/// What the tags of one slice say.
struct DicomSlice {
  std::string file;                     ///< name without folder
  std::string series;                   ///< series instance UID
  std::string description;              ///< of the series; may be empty
  Vec3d position;                       ///< centre of the first voxel, millimetres
  Vec3d row, column;                    ///< unit directions in which a row's and a column's voxels follow
  std::array<double, 2> spacing{1, 1};  ///< along rows (x) and columns (y), millimetres
  std::array<std::uint32_t, 2> size{};  ///< voxels in a row, rows
};

/// Slices that belong together, and the frame that they make.
struct DicomStack {
  std::vector<std::size_t> order;       ///< indices into the slices, in the order of their places
  Vec3d step;                           ///< from a slice's first voxel to the next slice's, millimetres
  std::vector<double> slice_positions;  ///< along the stack, millimetres; only where steps are uneven
  std::vector<std::string> warnings;
};

/// Slices of one series that lie alike (direction, size and spacing), by first appearance. `chosen` picks one of
/// several: its number, counted from 1, or its UID where that is one group's alone. Errors: bad_argument (several and
/// none chosen: they are listed; no such one).
Result<std::vector<std::size_t>> choose_series(std::span<const DicomSlice> slices, const std::string& chosen);

/// Puts slices that lie alike in order along their normal. Slices at the place of another are left out with a warning.
/// Errors: bad_format (missing slices: gaps of twice the usual step or more; several slices at every place),
/// unsupported (a single slice).
Result<DicomStack> stack_slices(std::span<const DicomSlice> slices, std::span<const std::size_t> chosen);

}  // namespace lodestone::io::detail
