// What the verbs found out, as plain figures: tables and JSON are made from these.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lodestone/chain/ladder/build_ladder.h"
#include "lodestone/core/level.h"
#include "lodestone/core/topology.h"
#include "lodestone/measure/attributes.h"
#include "lodestone/measure/distance.h"
#include "lodestone/measure/image.h"
#include "lodestone/measure/shape.h"

namespace lodestone::app {

struct LevelReport {
  std::size_t level = 0;
  std::size_t triangles = 0;
  std::optional<std::size_t> vanished_parts;  ///< drawn pieces of the input that have nothing left here; with --prune
  LevelError error;
  std::optional<measure::ImageDeviation> image;  ///< with --image-error
  std::string method;                            ///< as Level::method
  double switch_distance = 0;                    ///< model units
  std::uint64_t bytes = 0;
  std::string file;
  double seconds = 0;
};

/// What reading levels back has shown.
struct VerifyReport {
  std::size_t levels = 0;         ///< measured again, beside level 0
  double largest_difference = 0;  ///< of an error read back to the one told, as a share of it
};

struct BuildReport {
  std::string input;
  std::string failure;  ///< the error's line; empty = it worked and the rest holds
  std::string report;   ///< the page's file; empty without --report
  std::size_t triangles = 0;
  double diagonal = 0;
  std::string unit;     ///< empty = the model has none
  bool prunes = false;  ///< parts may vanish
  std::vector<LevelReport> levels;
  double read_seconds = 0, levels_seconds = 0, measure_seconds = 0, write_seconds = 0, total_seconds = 0;
  std::uint64_t peak_memory_bytes = 0;
  std::uint64_t total_bytes = 0;
  std::vector<std::string> warnings;
  std::vector<chain::Shortfall> shortfalls;
  std::optional<VerifyReport> verified;  ///< with --verify
};

struct SimplifyReport {
  std::string input, output, unit;
  std::size_t triangles_in = 0, triangles = 0;
  std::optional<std::size_t> vanished_parts;  ///< as in LevelReport
  LevelError error;
  std::string method, stop_reason, shortfall;
  simplify::LockCounts locked;
  double read_seconds = 0, simplify_seconds = 0, measure_seconds = 0, write_seconds = 0;
  std::uint64_t bytes = 0, peak_memory_bytes = 0;
  std::vector<std::string> warnings;
};

/// A surface coloured by its distance.
struct HeatReport {
  std::string file;
  double range = 0, largest = 0;  ///< distance of the last colour, and of the farthest vertex, model units
  std::uint64_t triangles = 0;    ///< of the file, where large ones of A are split
};

struct MeasureReport {
  std::string a, b, unit;
  measure::Distance distance;
  measure::Shape shape_a, shape_b;
  std::optional<measure::Attributes> attributes;  ///< with --attributes
  std::optional<measure::ImageDeviation> image;   ///< with --image
  std::optional<HeatReport> heat;                 ///< with --heat
  double seconds = 0;
};

struct AttributeReport {
  std::string name, semantic, type;
  std::uint32_t components = 0;
  bool normalized = false;
};

/// remesh, voxelize and boolean.
struct VoxelReport {
  std::string input, output, unit, fill, fill_reason, method, shortfall;
  std::array<std::uint32_t, 3> resolution{};  ///< of the solid
  std::uint32_t level_resolution = 0;         ///< of the surface, along the longest side; 0 for cubes
  std::uint64_t voxels_inside = 0;
  std::size_t triangles_in = 0, triangles = 0;
  std::optional<LevelError> error;  ///< remesh only
  double read_seconds = 0, prepare_seconds = 0, voxelize_seconds = 0, resample_seconds = 0, isosurface_seconds = 0,
         collapse_seconds = 0, measure_seconds = 0, write_seconds = 0, total_seconds = 0;
  std::uint64_t bytes = 0, peak_memory_bytes = 0;
  std::vector<std::string> warnings;
};

/// Counts are sums over what the default scene draws: a mesh placed twice counts twice.
struct InfoReport {
  std::string path, unit;
  Topology topology;
  std::uint64_t file_vertices = 0, file_triangles = 0;
  std::uint64_t meshes = 0, instances = 0, levels = 1;
  double diagonal = 0, area = 0, volume = 0;
  std::array<double, 3> min{}, max{};
  std::vector<AttributeReport> attributes;
  std::vector<std::string> materials;
  std::vector<std::string> warnings;
};

struct ConvertReport {
  std::string input;
  std::size_t triangles = 0;  ///< of the first file
  std::vector<std::string> files;
  std::vector<std::size_t> file_triangles;  ///< one a file where each is a level; else empty
  std::uint64_t bytes = 0;
  double read_seconds = 0, write_seconds = 0;
  std::vector<std::string> warnings;
};

struct RenderReport {
  std::string input, file, shading;
  std::size_t level = 0, triangles = 0;
  std::uint32_t width = 0, height = 0;
  std::array<double, 3> eye{}, forward{}, up{};
  std::optional<std::array<double, 2>> heat_range;
  std::uint64_t bytes = 0;
  double read_seconds = 0, prepare_seconds = 0, draw_seconds = 0, write_seconds = 0;
  std::vector<std::string> warnings;
};

/// A contact sheet.
struct SheetReport {
  struct Level {
    std::string input;
    std::size_t level = 0, triangles = 0;
    double error = 0, switch_distance = 0;  ///< model units
  };
  std::string file, shading, unit;
  std::vector<Level> levels;
  std::uint32_t width = 0, height = 0;
  std::uint64_t bytes = 0;
  double seconds = 0;
  std::vector<std::string> warnings;
};

struct SampleReport {
  std::string sample, file;
  std::size_t triangles = 0, vertices = 0, instances = 0;
  std::size_t voxels = 0, points = 0;  ///< of ct and scan, which have none of the others
  std::uint64_t bytes = 0;
  double seconds = 0;
};

}  // namespace lodestone::app
