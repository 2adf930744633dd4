#include "lodestone/io/points/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>

#include "lodestone/base/file.h"
#include "lodestone/core/mesh.h"
#include "lodestone/io/plain/ply_header_detail.h"
#include "lodestone/io/points/read_detail.h"
#include "lodestone/io/read_detail.h"

namespace lodestone::io {

namespace {

using Reader = Result<PointCloud> (*)(ByteReader, const Task&);

struct Format {
  std::string_view extension;
  Reader reader;
};

constexpr std::array<Format, 8> kFormats{{{".ply", read_ply_points},
                                          {".xyz", read_text_points},
                                          {".txt", read_text_points},
                                          {".asc", read_text_points},
                                          {".csv", read_text_points},
                                          {".pts", read_text_points},
                                          {".pcd", read_pcd},
                                          {".las", read_las}}};

// Refused, but with a line of its own.
constexpr std::array<std::string_view, 3> kRefused{".laz", ".ptx", ".e57"};

std::string convert_hint(std::string_view extension) {
  return fmt::format("convert it first: pdal translate in{} out.las", extension);
}

Result<PointCloud> read(ByteReader bytes, const std::string& extension, const Task& task) {
  for (const Format& f : kFormats) {
    if (f.extension != extension) continue;
    try {
      Result<PointCloud> cloud = f.reader(std::move(bytes), task);
      if (task.cancelled()) return cancelled_error("reading");
      return cloud;
    } catch (const std::bad_alloc&) {
      return fail(ErrorCode::out_of_memory, "needs more memory than there is", {},
                  "close other programs or use a machine with more");
    }
  }
  if (std::find(kRefused.begin(), kRefused.end(), extension) != kRefused.end()) {
    return fail(ErrorCode::unsupported, fmt::format("'{}' is not read", extension), bytes.name(),
                convert_hint(extension));
  }
  return fail(ErrorCode::unsupported, fmt::format("'{}' is not a format of points that can be read", extension),
              bytes.name(), "these can: .ply .xyz .txt .asc .csv .pts .pcd .las");
}

// Takes the points out whose numbers are not finite; returns how many.
std::uint64_t drop_non_finite(RawPoints& raw) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < raw.positions.size(); ++i) {
    // What a float can't hold is as bad.
    const Vec3d p = raw.positions[i];
    const double largest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    if (!is_finite(p) || largest > 3e38) continue;
    raw.positions[kept] = p;
    if (!raw.normals.empty()) raw.normals[kept] = raw.normals[i];
    if (!raw.colors.empty()) raw.colors[kept] = raw.colors[i];
    ++kept;
  }
  const std::uint64_t dropped = raw.positions.size() - kept;
  raw.positions.resize(kept);
  if (!raw.normals.empty()) raw.normals.resize(kept);
  if (!raw.colors.empty()) raw.colors.resize(kept);
  return dropped;
}

// To length 1, or to (0, 0, 0) where there is no direction; nothing where no point has one.
void clean_normals(std::vector<Vec3f>& normals, std::vector<std::string>& warnings) {
  std::uint64_t unknown = 0;
  for (Vec3f& n : normals) {
    const Vec3d d = to_double(n);
    n = is_finite(d) ? to_float(normalized(d)) : Vec3f{};
    if (n == Vec3f{}) ++unknown;
  }
  if (normals.empty() || unknown == 0) return;
  if (unknown == normals.size()) {
    warnings.emplace_back("the normals were left out: all are zero or not finite");
    normals.clear();
    return;
  }
  warnings.push_back(fmt::format("{} zero or not finite", counted(unknown, "normal is", "normals are")));
}

}  // namespace

tl::unexpected<Error> too_many_points(std::uint64_t count, std::string place) {
  return fail(ErrorCode::unsupported, fmt::format("{} points are more than 4,294,967,294", count_text(count)),
              std::move(place), "cut the cloud into parts");
}

Result<PointCloud> finish_points(RawPoints raw, std::string_view name) {
  PointCloud cloud;
  cloud.file_points = raw.positions.size();
  if (cloud.file_points >= kNone) return too_many_points(cloud.file_points, std::string(name));
  const std::uint64_t dropped = drop_non_finite(raw);
  if (raw.positions.empty()) {
    return fail(ErrorCode::empty,
                dropped > 0 ? fmt::format("has no points: none of {} is finite", count_text(dropped)) : "has no points",
                std::string(name), "was the export interrupted?");
  }
  if (dropped > 0) {
    raw.warnings.push_back(
        fmt::format("{} whose coordinates are not finite left out", counted(dropped, "point", "points")));
  }
  Box3d box;
  for (const Vec3d& p : raw.positions) box.add(p);
  cloud.offset = offset_for(box);
  cloud.positions.resize(raw.positions.size());
  for (std::size_t i = 0; i < raw.positions.size(); ++i) {
    cloud.positions[i] = to_float(raw.positions[i] - cloud.offset);
  }
  clean_normals(raw.normals, raw.warnings);
  cloud.normals = std::move(raw.normals);
  cloud.colors = std::move(raw.colors);
  cloud.warnings = std::move(raw.warnings);
  return cloud;
}

Result<PointCloud> read_points(const std::filesystem::path& path, const Task& task) {
  Result<ByteReader> bytes = ByteReader::open(path);
  LODESTONE_TRY(bytes);
  Result<PointCloud> cloud = read(std::move(*bytes), extension_of(path), task);
  if (!cloud && cloud.error().where.empty()) cloud.error().where = path.string();
  return cloud;
}

Result<PointCloud> read_points(std::span<const std::byte> bytes, std::string_view name, const Task& task) {
  return read(ByteReader::over(bytes, std::string(name)), extension_of(std::filesystem::path(name)), task);
}

bool looks_like_points(const std::filesystem::path& path, std::string_view head) {
  const std::string extension = extension_of(path);
  if (std::find(kRefused.begin(), kRefused.end(), extension) != kRefused.end()) return true;
  if (std::none_of(kFormats.begin(), kFormats.end(), [&](const Format& f) { return f.extension == extension; })) {
    return false;
  }
  return extension != ".ply" || ply_names_only_points(head);
}

}  // namespace lodestone::io
