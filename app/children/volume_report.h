// What the command and the program that reads volumes for it say to each other.
#pragma once

#include <string>
#include <vector>

#include "app/children/child_report.h"
#include "lodestone/io/volumes/read.h"

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

/// Says all of a volume but its values.
void say_volume(const VolumeHeader& header, io::VoxelType type);
struct SaidVolume {
  VolumeHeader header;
  io::VoxelType type = io::VoxelType::uint8;
};
/// The same read back.
SaidVolume volume_of(const ChildReport& report);

}  // namespace lodestone::app
