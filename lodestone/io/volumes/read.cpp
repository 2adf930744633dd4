#include "lodestone/io/volumes/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "lodestone/base/file.h"
#include "lodestone/io/volumes/bare_values_detail.h"
#include "lodestone/io/volumes/itk_detail.h"
#include "lodestone/io/volumes/names_detail.h"

namespace lodestone::io {
namespace fs = std::filesystem;

namespace {

Result<void> read_folder(const fs::path& folder, const VolumeReadOptions& options, const VolumeSink& sink,
                         const Task& task) {
  const Result<std::vector<fs::path>> files = detail::files_of(folder);
  LODESTONE_TRY(files);
  std::vector<fs::path> slices, pictures;
  for (const fs::path& file : *files) {
    if (detail::is_picture(file)) {
      pictures.push_back(file);
    } else if (extension_of(file) == ".dcm" || detail::is_dicom(file)) {
      slices.push_back(file);
    }
  }
  if (!slices.empty()) return detail::read_itk_series(folder, slices, options.series, sink, task);
  if (pictures.size() >= 2) return detail::read_itk_pictures(pictures, sink, task);
  return fail(ErrorCode::empty, "holds no slices", folder.string(), "DICOM, PNG and TIFF slices are read");
}

Result<void> read_raw(const fs::path& path, const RawLayout& raw, const VolumeSink& sink, const Task& task) {
  VolumeHeader header;
  header.grid = {raw.size, raw.spacing * -0.5, raw.spacing};
  for (std::size_t k = 0; k < 3; ++k) {
    if (raw.size[k] >= 1 && raw.size[k] <= 65'535 && raw.spacing[k] > 0 && std::isfinite(raw.spacing[k])) continue;
    return fail(ErrorCode::bad_argument,
                fmt::format("{} x {} x {} voxels of {} x {} x {} mm are no volume", raw.size[0], raw.size[1],
                            raw.size[2], raw.spacing.x, raw.spacing.y, raw.spacing.z),
                path.string(), "use 1 to 65,535 voxels of a size above 0");
  }
  header.meters_per_unit = 0.001;
  header.files = {path};
  const bool whole = raw.skip_bytes == 0;
  return detail::send_bare_values(path, header, {raw.type, raw.big_endian, raw.skip_bytes, 1, 0}, whole, sink, task);
}

template <class T>
VolumeValues values_of(const std::vector<std::byte>& bytes) {
  return std::span(reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T));
}

}  // namespace

Result<void> read_volume(const fs::path& path, const VolumeReadOptions& options, const VolumeSink& sink, Task task) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return read_folder(path, options, sink, task);
  if (const Result<InputFile> file = InputFile::open(path); !file) return fail(file.error());
  if (options.raw) return read_raw(path, *options.raw, sink, task);
  if (detail::is_nifti2(path)) return detail::read_nifti2(path, sink, task);
  return detail::read_itk_file(path, sink, task);
}

Result<ScannedVolume> read_volume(const fs::path& path, const VolumeReadOptions& options, Task task) {
  ScannedVolume volume;
  const auto bytes = std::make_shared<std::vector<std::byte>>();
  VoxelType type = VoxelType::uint8;
  VolumeSink sink;
  sink.begin = [&](const VolumeHeader& header, VoxelType of) -> Result<void> {
    volume.header = header;
    type = of;
    return {};
  };
  sink.slice = [&](std::span<const std::byte> values) -> Result<void> {
    bytes->insert(bytes->end(), values.begin(), values.end());
    return {};
  };
  LODESTONE_TRY(read_volume(path, options, sink, task));
  switch (type) {
    case VoxelType::uint8:
      volume.values = values_of<std::uint8_t>(*bytes);
      break;
    case VoxelType::int16:
      volume.values = values_of<std::int16_t>(*bytes);
      break;
    case VoxelType::uint16:
      volume.values = values_of<std::uint16_t>(*bytes);
      break;
    case VoxelType::float32:
      volume.values = values_of<float>(*bytes);
      break;
  }
  volume.storage = bytes;
  return volume;
}

}  // namespace lodestone::io
