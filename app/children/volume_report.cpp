#include "app/children/volume_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <span>

#include "lodestone/base/units.h"

namespace lodestone::app {

namespace {

std::string list(std::span<const double> values) { return fmt::format("{}", fmt::join(values, " ")); }

std::string list(const Vec3d& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

Vec3d vector(const std::vector<double>& v) { return v.size() == 3 ? Vec3d{v[0], v[1], v[2]} : Vec3d{}; }

}  // namespace

std::vector<std::string> volume_words(const std::filesystem::path& volume, const std::filesystem::path& values,
                                      const io::VolumeReadOptions& options) {
  std::vector<std::string> words{kVolumeReader, volume.string(), values.string(), options.series};
  if (options.raw) {
    const io::RawLayout& raw = *options.raw;
    for (const std::uint32_t n : raw.size) words.push_back(fmt::format("{}", n));
    for (std::size_t k = 0; k < 3; ++k) words.push_back(fmt::format("{}", raw.spacing[k]));
    words.push_back(raw.type);
    words.push_back(raw.big_endian ? "1" : "0");
    words.push_back(fmt::format("{}", raw.skip_bytes));
  }
  return words;
}

Result<VolumeWords> parse_volume_words(const std::vector<std::string>& words) {
  if (words.size() != 4 && words.size() != 13) {
    return fail(ErrorCode::bad_argument, "is started by lod, not by hand", kVolumeReader);
  }
  VolumeWords out{words[1], words[2], {words[3], {}}};
  if (words.size() == 4) return out;
  io::RawLayout raw;
  for (std::size_t k = 0; k < 3; ++k) {
    raw.size[k] = static_cast<std::uint32_t>(std::strtoul(words[4 + k].c_str(), nullptr, 10));
    raw.spacing[k] = parse_number(words[7 + k]).value_or(0);
  }
  raw.type = words[10];
  raw.big_endian = words[11] == "1";
  raw.skip_bytes = std::strtoull(words[12].c_str(), nullptr, 10);
  out.options.raw = raw;
  return out;
}

void say_volume(const VolumeHeader& header, io::VoxelType type) {
  const VoxelGrid& grid = header.grid;
  say("size", fmt::format("{} {} {}", grid.size[0], grid.size[1], grid.size[2]));
  say("origin", list(grid.origin));
  say("spacing", list(grid.spacing));
  say("to_world", list(header.to_world.m));
  say("patient_axes", header.patient_axes ? "1" : "0");
  say("unit", fmt::format("{}", header.meters_per_unit));
  if (!header.slice_positions.empty()) say("positions", list(header.slice_positions));
  for (const std::filesystem::path& file : header.files) say("file", file.string());
  for (const std::string& warning : header.warnings) say("warning", warning);
  say("type", fmt::format("{}", static_cast<int>(type)));
}

SaidVolume volume_of(const ChildReport& report) {
  SaidVolume said;
  const std::vector<double> size = report.numbers("size");
  for (std::size_t k = 0; k < 3 && k < size.size(); ++k) {
    said.header.grid.size[k] = static_cast<std::uint32_t>(size[k]);
  }
  said.header.grid.origin = vector(report.numbers("origin"));
  said.header.grid.spacing = vector(report.numbers("spacing"));
  const std::vector<double> m = report.numbers("to_world");
  if (m.size() == said.header.to_world.m.size()) std::copy(m.begin(), m.end(), said.header.to_world.m.begin());
  said.header.patient_axes = report.value("patient_axes") == "1";
  said.header.meters_per_unit = report.number("unit");
  said.header.slice_positions = report.numbers("positions");
  for (const std::string& file : report.values("file")) said.header.files.emplace_back(file);
  said.header.warnings = report.values("warning");
  said.type = static_cast<io::VoxelType>(static_cast<int>(report.number("type")));
  return said;
}

}  // namespace lodestone::app
