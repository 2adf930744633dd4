// What is a volume by name and first bytes. Apart from reading, so that programs that only ask don't carry readers.
#include "lodestone/io/volumes/names_detail.h"

#include <algorithm>
#include <array>
#include <system_error>

#include "lodestone/base/file.h"
#include "lodestone/io/read.h"
#include "lodestone/io/volumes/read.h"

namespace lodestone::io {
namespace fs = std::filesystem;

namespace detail {

bool is_picture(const fs::path& path) {
  const std::string ending = extension_of(path);
  return ending == ".png" || ending == ".tif" || ending == ".tiff";
}

bool is_dicom(const fs::path& path) {
  Result<InputFile> file = InputFile::open(path);
  std::array<std::byte, 4> mark{};
  if (!file || file->size() < 132 || !file->seek(128)) return false;
  const Result<std::size_t> got = file->read(mark);
  return got && *got == 4 && mark == std::array{std::byte{'D'}, std::byte{'I'}, std::byte{'C'}, std::byte{'M'}};
}

Result<std::vector<fs::path>> files_of(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored)) files.push_back(entry->path());
  }
  if (error) return fail(ErrorCode::cannot_read, error.message(), folder.string());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace detail

using detail::files_of;
using detail::is_dicom;
using detail::is_picture;

std::size_t size_of(VoxelType type) { return type == VoxelType::uint8 ? 1 : type == VoxelType::float32 ? 4 : 2; }

bool is_volume_name(const fs::path& path) {
  const std::string name = path.filename().string();
  std::string ending = extension_of(path);
  if (ending == ".gz") ending = extension_of(path.stem());
  const auto known = {".nrrd", ".nhdr", ".mha", ".mhd", ".nii", ".dcm", ".tif", ".tiff"};
  return std::any_of(known.begin(), known.end(), [&](const char* k) { return ending == k; });
}

bool is_volume_folder(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) return false;
  const Result<std::vector<fs::path>> files = files_of(path);
  if (!files) return false;
  std::size_t pictures = 0;
  bool dicom = false;
  for (const fs::path& file : *files) {
    const std::string ending = extension_of(file);
    if (is_model_extension(ending)) return false;
    if (is_picture(file)) ++pictures;
    dicom = dicom || ending == ".dcm" || ((ending.empty() || ending.size() > 5) && is_dicom(file));
  }
  return dicom || pictures >= 2;
}

}  // namespace lodestone::io
