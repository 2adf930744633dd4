// What the program that reads volumes says to the command that started it: lines of "key value".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lodestone/io/volume.h"

namespace lodestone::app {

/// The name of that program, which stands beside `lod`.
inline constexpr const char* kVolumeReader = "lod-read-volume";

/// Words for the program's command line: the volume, the file for its values, the options.
std::vector<std::string> volume_words(const std::filesystem::path& volume, const std::filesystem::path& values,
                                      const io::VolumeReadOptions& options);
struct VolumeWords {
  std::filesystem::path volume, values;
  io::VolumeReadOptions options;
};
/// The same read back. Errors: bad_argument.
Result<VolumeWords> parse_volume_words(const std::vector<std::string>& words);

/// Lines about a volume.
std::string report_of(const VolumeHeader& header, io::VoxelType type);
std::string report_of(const Error& error);

struct VolumeSaid {
  VolumeHeader header;
  io::VoxelType type = io::VoxelType::uint8;
  bool done = false, failed = false;
  Error error;
};
VolumeSaid parse_volume_report(const std::string& text);

}  // namespace lodestone::app
