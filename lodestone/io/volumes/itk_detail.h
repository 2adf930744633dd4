// The formats that ITK reads, where it is built in (LODESTONE_WITH_ITK).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/io/volumes/read.h"

namespace lodestone::io::detail {

/// One file: NRRD, MetaImage, NIfTI 1, TIFF, DICOM with many frames.
Result<void> read_itk_file(const std::filesystem::path& path, const VolumeSink& sink, const Task& task);
/// DICOM slices among the files of a folder; empty when there is none.
Result<void> read_itk_series(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& files,
                             const std::string& series, const VolumeSink& sink, const Task& task);
/// Pictures, a slice each, in the order given.
Result<void> read_itk_pictures(const std::vector<std::filesystem::path>& files, const VolumeSink& sink,
                               const Task& task);

/// The type that holds values of a component type by its name ("int8", "float64").
VoxelType type_for(const std::string& component);

}  // namespace lodestone::io::detail
