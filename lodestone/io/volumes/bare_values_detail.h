// Volumes whose values stand bare in a file, maybe behind a header and gzip.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/io/volumes/read.h"

namespace lodestone::io::detail {

/// How values are stored, and what they mean: slope * value + intercept.
struct BareValues {
  std::string component;  ///< "uint8", "int8", "uint16", "int16", "uint32", "int32", "float32" or "float64"
  bool big_endian = false;
  std::uint64_t skip_bytes = 0;
  double slope = 1, intercept = 0;
};

/// Bytes of a component; 0 for names that are none.
std::size_t component_bytes(const std::string& component);

/// Sends the header and the slices of its grid; a file that is packed by gzip is unpacked. Errors: cannot_read,
/// bad_argument (no such component), bad_format (the file ends early, or goes on where it should not).
Result<void> send_bare_values(const std::filesystem::path& path, const VolumeHeader& header, const BareValues& values,
                              bool whole_file, const VolumeSink& sink, const Task& task);

/// True where the file, unpacked, begins as NIfTI 2.
bool is_nifti2(const std::filesystem::path& path);
/// NIfTI 2, one file (.nii, .nii.gz). Errors: as above, unsupported.
Result<void> read_nifti2(const std::filesystem::path& path, const VolumeSink& sink, const Task& task);

}  // namespace lodestone::io::detail
