// Files that are slices.
#pragma once

#include <filesystem>
#include <vector>

#include "lodestone/base/result.h"

namespace lodestone::io::detail {

/// By its ending: PNG or TIFF.
bool is_picture(const std::filesystem::path& path);
/// By its content: "DICM" after 128 bytes.
bool is_dicom(const std::filesystem::path& path);
/// The files of a folder, by name. Errors: cannot_read.
Result<std::vector<std::filesystem::path>> files_of(const std::filesystem::path& folder);

}  // namespace lodestone::io::detail
