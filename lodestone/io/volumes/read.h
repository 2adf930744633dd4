// Reading volumes: CT and MRI series, single files, stacks of pictures, raw values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/scanned_volume.h"

namespace lodestone::io {

/// The types in which values are handed on; all others are converted to the least that holds them, or to float32.
enum class VoxelType { uint8, int16, uint16, float32 };
std::size_t size_of(VoxelType type);

/// What a file without a header can't say of itself.
struct RawLayout {
  std::array<std::uint32_t, 3> size{};  ///< voxels along x (fastest), y, z
  std::string type = "uint8";           ///< uint8, int8, uint16, int16, uint32, int32, float32 or float64
  bool big_endian = false;
  std::uint64_t skip_bytes = 0;  ///< before the first value
  Vec3d spacing{1, 1, 1};        ///< of voxels, millimetres
};

struct VolumeReadOptions {
  std::string series;            ///< of a folder with several: its number in the list that the error gives, or its UID
  std::optional<RawLayout> raw;  ///< reads the file as bare values
};

/// Takes a volume in pieces, so that none need be in memory whole.
struct VolumeSink {
  std::function<Result<void>(const VolumeHeader& header, VoxelType type)> begin;  ///< first, once
  std::function<Result<void>(std::span<const std::byte> values)> slice;  ///< then the slices from z = 0 on, in `type`
};

/// Reads DICOM (a folder of one series, or one file with many frames), NRRD, MetaImage, NIfTI 1 and 2, TIFF with many
/// pages, a folder of PNG or TIFF slices by name, or bare values. DICOM: slices are put in order by their position
/// tags along the normal of their orientation, never by name or thickness; a tilted gantry gives a sheared frame, and
/// uneven steps keep each slice where it is; stored values are rescaled (Hounsfield units). Of files with several
/// volumes the first is read, which is told. Errors: cannot_read, bad_format (cut off, missing slices, ...),
/// bad_argument (several series: the error lists them), unsupported (colours, one slice alone, not built in), empty,
/// out_of_memory, cancelled.
Result<void> read_volume(const std::filesystem::path& path, const VolumeReadOptions& options, const VolumeSink& sink,
                         Task task = {});

/// The whole volume in memory. Errors as above.
Result<ScannedVolume> read_volume(const std::filesystem::path& path, const VolumeReadOptions& options = {},
                                  Task task = {});

/// True for the endings of volumes: .nrrd, .nhdr, .mha, .mhd, .nii, .nii.gz, .dcm, .tif, .tiff.
bool is_volume_name(const std::filesystem::path& path);

/// True for a folder whose files are slices: it has no model, and DICOM files or several pictures.
bool is_volume_folder(const std::filesystem::path& path);

}  // namespace lodestone::io
