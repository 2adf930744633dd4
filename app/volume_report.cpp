#include "app/volume_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace lodestone::app {

namespace {

std::string one_line(std::string value) {
  std::replace(value.begin(), value.end(), '\n', ' ');
  std::replace(value.begin(), value.end(), '\r', ' ');
  return value;
}

std::string line(std::string_view key, const std::string& value) {
  return fmt::format("{} {}\n", key, one_line(value));
}

std::string list(const double* values, std::size_t count) {
  return fmt::format("{}", fmt::join(values, values + count, " "));
}

std::vector<double> numbers(const std::string& text) {
  std::istringstream words(text);
  std::vector<double> out;
  for (std::string word; words >> word;) out.push_back(std::strtod(word.c_str(), nullptr));
  return out;
}

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
    raw.spacing[k] = std::strtod(words[7 + k].c_str(), nullptr);
  }
  raw.type = words[10];
  raw.big_endian = words[11] == "1";
  raw.skip_bytes = std::strtoull(words[12].c_str(), nullptr, 10);
  out.options.raw = raw;
  return out;
}

std::string report_of(const VolumeHeader& header, io::VoxelType type) {
  const VoxelGrid& grid = header.grid;
  std::string out = line("size", fmt::format("{} {} {}", grid.size[0], grid.size[1], grid.size[2]));
  out += line("origin", fmt::format("{} {} {}", grid.origin.x, grid.origin.y, grid.origin.z));
  out += line("spacing", fmt::format("{} {} {}", grid.spacing.x, grid.spacing.y, grid.spacing.z));
  out += line("to_world", list(header.to_world.m.data(), 16));
  out += line("patient_axes", header.patient_axes ? "1" : "0");
  out += line("unit", fmt::format("{}", header.meters_per_unit));
  if (!header.slice_positions.empty()) {
    out += line("positions", list(header.slice_positions.data(), header.slice_positions.size()));
  }
  for (const std::filesystem::path& file : header.files) out += line("file", file.string());
  for (const std::string& warning : header.warnings) out += line("warning", warning);
  return out + line("type", fmt::format("{}", static_cast<int>(type)));
}

std::string report_of(const Error& error) {
  return line("code", fmt::format("{}", static_cast<int>(error.code))) + line("what", error.what) +
         line("where", error.where) + line("remedy", error.remedy) + line("failed", "");
}

VolumeSaid parse_volume_report(const std::string& text) {
  VolumeSaid said;
  std::istringstream lines(text);
  for (std::string row; std::getline(lines, row);) {
    const std::size_t space = std::min(row.find(' '), row.size());
    const std::string key = row.substr(0, space);
    const std::string value = row.substr(std::min(space + 1, row.size()));
    if (key == "size") {
      const std::vector<double> size = numbers(value);
      for (std::size_t k = 0; k < 3 && k < size.size(); ++k) {
        said.header.grid.size[k] = static_cast<std::uint32_t>(size[k]);
      }
    }
    if (key == "origin") said.header.grid.origin = vector(numbers(value));
    if (key == "spacing") said.header.grid.spacing = vector(numbers(value));
    if (key == "to_world") {
      const std::vector<double> m = numbers(value);
      if (m.size() == 16) std::copy(m.begin(), m.end(), said.header.to_world.m.begin());
    }
    if (key == "patient_axes") said.header.patient_axes = value == "1";
    if (key == "unit") said.header.meters_per_unit = std::strtod(value.c_str(), nullptr);
    if (key == "positions") said.header.slice_positions = numbers(value);
    if (key == "file") said.header.files.emplace_back(value);
    if (key == "warning") said.header.warnings.push_back(value);
    if (key == "type") said.type = static_cast<io::VoxelType>(std::atoi(value.c_str()));
    if (key == "code") said.error.code = static_cast<ErrorCode>(std::atoi(value.c_str()));
    if (key == "what") said.error.what = value;
    if (key == "where") said.error.where = value;
    if (key == "remedy") said.error.remedy = value;
    if (key == "done") said.done = true;
    if (key == "failed") said.failed = true;
  }
  return said;
}

}  // namespace lodestone::app
