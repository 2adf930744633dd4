#include "lodestone/io/read_detail.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>

#include "lodestone/base/units.h"
#include "lodestone/core/validate.h"
#include "lodestone/core/weld.h"

namespace lodestone::io {

bool ReadProgress::go_on(std::uint64_t position) {
  constexpr std::uint64_t kStep = std::uint64_t{1} << 20;
  if (position >= told_ + kStep && size_ > 0) {
    task_.advance(static_cast<double>(position - told_) / static_cast<double>(size_));
    told_ = position;
  }
  return !task_.cancelled();
}

std::string line_place(std::string_view name, std::uint64_t line) { return fmt::format("{}:{}", name, line); }
std::string byte_place(std::string_view name, std::uint64_t byte) { return fmt::format("{}: byte {}", name, byte); }

std::string count_text(std::uint64_t count) {
  if (count >= (std::uint64_t{1} << 32) && std::has_single_bit(count)) {
    return fmt::format("2^{}", std::countr_zero(count));
  }
  return with_separators(count);
}

std::string size_text(double bytes) {
  constexpr std::array kUnits{"KiB", "MiB", "GiB", "TiB", "PiB", "EiB", "ZiB"};
  if (bytes < 1024) return fmt::format("{} bytes", static_cast<int>(bytes));
  std::size_t unit = 0;
  bytes /= 1024;
  while (bytes >= 1024 && unit + 1 < kUnits.size()) {
    bytes /= 1024;
    ++unit;
  }
  return bytes < 10 && bytes != std::floor(bytes) ? fmt::format("{:.1f} {}", bytes, kUnits[unit])
                                                  : fmt::format("{:.0f} {}", bytes, kUnits[unit]);
}

tl::unexpected<Error> count_too_large(std::string_view what, std::uint64_t count, std::uint64_t bytes_each,
                                      std::uint64_t file_bytes, std::string place) {
  return fail(ErrorCode::bad_format,
              fmt::format("{} count {} needs {}, the file has {}", what, count_text(count),
                          size_text(static_cast<double>(count) * static_cast<double>(bytes_each)),
                          size_text(static_cast<double>(file_bytes))),
              std::move(place), "is it cut off?");
}

Vec3d offset_for(const Box3d& box) {
  if (box.empty()) return {};
  const Vec3d size = box.size(), center = box.center();
  const double extent = std::max({size.x, size.y, size.z});
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i) largest = std::max({largest, std::abs(box.min[i]), std::abs(box.max[i])});
  // A float is right to 2^-24 of the coordinate: below this factor that is 2^-21 of the model, finer than it needs.
  constexpr double kFar = 8;
  if (!(extent > 0) || !(largest > kFar * extent) || !std::isfinite(largest)) return {};
  // Rounded to a power of two near the model's size, so that subtracting it loses nothing.
  int exponent = 0;
  std::frexp(extent, &exponent);
  const double unit = std::ldexp(1.0, exponent - 1);
  Vec3d offset;
  for (std::size_t i = 0; i < 3; ++i) offset[i] = std::floor(center[i] / unit + 0.5) * unit;
  return is_finite(offset) ? offset : Vec3d{};
}

void set_positions(Mesh& mesh, std::span<const Vec3d> positions) {
  Box3d box;
  for (const Vec3d& p : positions) box.add(p);
  mesh.offset = offset_for(box);
  mesh.positions.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) mesh.positions[i] = to_float(positions[i] - mesh.offset);
}

namespace {

bool all_finite(const std::vector<Vec3f>& positions) {
  constexpr std::size_t kBlock = 1024;
  for (std::size_t begin = 0; begin < positions.size(); begin += kBlock) {
    const std::size_t end = std::min(positions.size(), begin + kBlock);
    float zero = 0;  // stays zero as long as all are finite
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f p = positions[i];
      zero += p.x * 0 + p.y * 0 + p.z * 0;
    }
    if (!(zero == 0)) return false;
  }
  return true;
}

// Positions that are not finite are an error where a triangle uses them, and otherwise vanish in the weld.
Result<void> check_positions(const Mesh& mesh, std::string_view name, std::uint64_t first_vertex) {
  if (all_finite(mesh.positions)) return {};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.vertices_of(t)) {
      const Vec3f p = mesh.positions[v];
      if (is_finite(p)) continue;
      return fail(ErrorCode::bad_format,
                  fmt::format("vertex {} is at ({}, {}, {}): coordinates must be finite and at most 3.4e38",
                              v + first_vertex, p.x, p.y, p.z),
                  std::string(name), "repair or remove it and the faces that use it");
    }
  }
  return {};
}

template <class T>
std::uint64_t zero_non_finite(std::vector<T>& values) {
  std::uint64_t count = 0;
  for (T& value : values) {
    if (std::isfinite(value)) continue;
    value = 0;
    ++count;
  }
  return count;
}

void clean_attributes(Model& model) {
  for (AttributeStream& stream : model.meshes[0].attributes) {
    std::uint64_t count = 0;
    if (auto* floats = std::get_if<std::vector<float>>(&stream.values)) count = zero_non_finite(*floats);
    if (auto* doubles = std::get_if<std::vector<double>>(&stream.values)) count = zero_non_finite(*doubles);
    if (count > 0) {
      model.warnings.push_back(
          fmt::format("{} of attribute '{}' not finite: set to zero", counted(count, "value", "values"), stream.name));
    }
  }
}

}  // namespace

Result<Model> finish_model(Model model, std::string_view name, std::uint64_t first_vertex, Task task) {
  Mesh& mesh = model.meshes[0];
  if (mesh.triangles.empty()) {
    return fail(ErrorCode::empty,
                fmt::format("has no triangles: {} and {}", counted(model.file_vertices, "vertex", "vertices"),
                            counted(model.file_triangles, "triangle", "triangles")),
                std::string(name), model.file_vertices > 0 ? "is it a point cloud?" : "was the export interrupted?");
  }
  LODESTONE_TRY(check_positions(mesh, name, first_vertex));
  clean_attributes(model);
  Result<Mesh> welded = weld_exact(std::move(mesh), task);
  LODESTONE_TRY(welded);
  mesh = std::move(*welded);
  if (Result<void> valid = validate(model); !valid) {
    valid.error().code = ErrorCode::bad_format;
    valid.error().where = std::string(name);
    return fail(valid.error());
  }
  return model;
}

std::string counted(std::uint64_t count, std::string_view singular, std::string_view plural) {
  return with_separators(count) + " " + std::string(count == 1 ? singular : plural);
}

}  // namespace lodestone::io
