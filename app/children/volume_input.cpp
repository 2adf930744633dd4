#include "app/children/volume_input.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <system_error>

#include "app/children/child_process.h"
#include "app/children/volume_report.h"
#include "lodestone/base/file.h"
#include "lodestone/base/mapped_file.h"
#include "lodestone/base/units.h"
#include "lodestone/io/points/read.h"

namespace lodestone::app {
namespace fs = std::filesystem;

OptionGroup volume_group() {
  return {"Volumes (CT, MRI, stacks of slices)",
          {{"--iso",
            "",
            "V",
            "",
            "the volume's values, such as Hounsfield units",
            "make the surface at this value; larger values are inside (without: a threshold by Otsu's method)",
            {},
            Completion::none},
           {"--labels",
            "",
            "",
            "",
            "",
            "values are labels of a segmentation: one mesh for each label but 0",
            {},
            Completion::none},
           {"--smooth",
            "",
            "R",
            "",
            "voxels, or millimetres: 1.5mm",
            "first blur values by a Gaussian of this standard deviation",
            {},
            Completion::none},
           {"--median",
            "",
            "",
            "",
            "",
            "first take the median of 3 x 3 x 3 values, against speckles",
            {},
            Completion::none},
           {"--trilinear",
            "",
            "",
            "",
            "",
            "resolve ambiguous cells as the trilinear interpolant does (without: always separated)",
            {},
            Completion::none},
           {"--series",
            "",
            "S",
            "",
            "",
            "which series of a folder: its number in the list, or its UID",
            {},
            Completion::none},
           {"--raw",
            "",
            "X,Y,Z",
            "",
            "voxels",
            "the file holds bare values: how many along x, y and z",
            {},
            Completion::none},
           {"--raw-type",
            "",
            "T",
            "uint8",
            "",
            "their type; with 'be' at its end, big-endian, such as int16be",
            {"uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64", "uint16be", "int16be",
             "uint32be", "int32be", "float32be", "float64be"},
            Completion::choices},
           {"--raw-spacing", "", "X,Y,Z", "1,1,1", "millimetres", "size of a voxel", {}, Completion::none},
           {"--raw-skip", "", "N", "0", "bytes", "skip this much before the first value", {}, Completion::none}}};
}

OptionGroup scan_group(bool close) {
  OptionGroup group{"Scans (points in PLY, PCD, LAS, XYZ)",
                    {{"--scan-resolution",
                      "",
                      "N",
                      "",
                      "voxels",
                      "resolution of the surface along its longest side (without: by the points' spacing)",
                      {},
                      Completion::none},
                     {"--splat",
                      "",
                      "",
                      "",
                      "",
                      "ignore normals: fill the voxels that hold points and what these enclose",
                      {},
                      Completion::none}}};
  if (close) {
    group.options.push_back({"--close",
                             "",
                             "R",
                             "",
                             "length: 1% of the diagonal, or 2mm",
                             "holes up to twice this radius are closed (without: by the scan)",
                             {},
                             Completion::none});
  }
  return group;
}

namespace {

tl::unexpected<Error> bad_value(const char* option, const std::string& text, const char* remedy) {
  return fail(ErrorCode::bad_argument, fmt::format("{} {} can't be read", option, text), {}, remedy);
}

// Three numbers with commas between them.
Result<Vec3d> triple(const Arguments& arguments, const char* option) {
  const std::string text = arguments.text(option);
  Vec3d out;
  const std::vector<std::string> words = split_commas(text);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::optional<double> number = words.size() == 3 ? parse_number(words[k]) : std::nullopt;
    if (!number) return bad_value(option, text, "use three numbers, such as 256,256,128");
    out[k] = *number;
  }
  return out;
}

Result<io::RawLayout> raw_layout(const Arguments& arguments) {
  io::RawLayout raw;
  const Result<Vec3d> size = triple(arguments, "--raw");
  LODESTONE_TRY(size);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!((*size)[k] >= 1) || (*size)[k] > 65'535 || (*size)[k] != std::floor((*size)[k])) {
      return bad_value("--raw", arguments.text("--raw"), "use three counts of voxels, 1 to 65535 each");
    }
    raw.size[k] = static_cast<std::uint32_t>((*size)[k]);
  }
  const Result<Vec3d> spacing = triple(arguments, "--raw-spacing");
  LODESTONE_TRY(spacing);
  if (!(spacing->x > 0 && spacing->y > 0 && spacing->z > 0)) {
    return bad_value("--raw-spacing", arguments.text("--raw-spacing"), "use sizes above 0");
  }
  raw.spacing = *spacing;
  raw.type = arguments.text("--raw-type");
  if (raw.type.ends_with("be")) {
    raw.type.resize(raw.type.size() - 2);
    raw.big_endian = true;
  }
  const Result<std::uint64_t> skip = arguments.count("--raw-skip", 0, std::uint64_t{1} << 40);
  LODESTONE_TRY(skip);
  raw.skip_bytes = *skip;
  return raw;
}

Result<void> read_smoothing(const Arguments& arguments, chain::VolumeSurfaceOptions& options) {
  options.median = arguments.has("--median");
  options.trilinear = arguments.has("--trilinear");
  if (!arguments.has("--smooth")) return {};
  const std::string text = arguments.text("--smooth");
  options.smooth_in_voxels = !text.ends_with("mm");
  const std::optional<double> radius =
      parse_number(std::string_view(text).substr(0, text.size() - (options.smooth_in_voxels ? 0 : 2)));
  if (!radius || !(*radius > 0) || *radius > 1000) {
    return bad_value("--smooth", text, "use voxels, such as 1.5, or millimetres, such as 2mm");
  }
  options.smooth = *radius;
  return {};
}

// The program stands beside this one, or, when installed, in ../libexec/lodestone.
Result<fs::path> reader_program() {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  for (const fs::path& place : {self.parent_path() / kVolumeReader,
                                self.parent_path().parent_path() / "libexec" / "lodestone" / kVolumeReader}) {
    if (::access(place.c_str(), X_OK) == 0) return place;
  }
  return fail(ErrorCode::unsupported, fmt::format("the program {} that reads volumes is not installed", kVolumeReader),
              self.parent_path().string(), "install it beside lod");
}

std::uint64_t bytes_of(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) return fs::file_size(path, ignored);
  std::uint64_t sum = 0;
  std::error_code error;
  for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->is_regular_file(ignored)) sum += entry->file_size(ignored);
  }
  return sum;
}

template <class T>
std::span<const T> typed(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
}

VolumeValues typed_values(std::span<const std::byte> bytes, io::VoxelType type) {
  switch (type) {
    case io::VoxelType::uint8:
      return typed<std::uint8_t>(bytes);
    case io::VoxelType::int16:
      return typed<std::int16_t>(bytes);
    case io::VoxelType::uint16:
      return typed<std::uint16_t>(bytes);
    case io::VoxelType::float32:
      break;
  }
  return typed<float>(bytes);
}

Result<ScannedVolume> read_in_child(const fs::path& path, const VolumeRequest& request, const Task& task) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return fail(InputFile::open(path).error());
  const Result<fs::path> program = reader_program();
  LODESTONE_TRY(program);
  const TemporaryFolder folder;
  if (folder.path().empty()) {
    return fail(ErrorCode::cannot_write, "no temporary folder could be made", path.string(), "set TMPDIR to one");
  }
  const fs::path values = folder.path() / "values";
  const ChildLimits limits = limits_for(bytes_of(path));
  const Result<ChildOutcome> outcome = run_child(*program, volume_words(path, values, request.read), limits, task);
  LODESTONE_TRY(outcome);
  if (outcome->end == ChildOutcome::End::cancelled) return cancelled_error("reading");
  if (outcome->report.failed) return fail(outcome->report.error);
  if (!outcome->report.done || outcome->status != 0) {
    return fail(ErrorCode::bad_format, ending_of(*outcome, limits), path.string(),
                "convert it to NRRD or MetaImage with the program that made it");
  }
  const Result<MappedFile> mapped = map_file(values);
  LODESTONE_TRY(mapped);
  SaidVolume said = volume_of(outcome->report);
  ScannedVolume volume;
  volume.header = std::move(said.header);
  if (mapped->bytes.size() != volume.header.grid.count() * io::size_of(said.type)) {
    return fail(ErrorCode::bad_format, "has not as many values as it says", path.string());
  }
  volume.values = typed_values(mapped->bytes, said.type);
  volume.storage = mapped->mapping;
  return volume;
}

}  // namespace

Result<VolumeRequest> volume_request(const Arguments& arguments) {
  VolumeRequest request;
  request.up = up_axis(arguments);
  request.read.series = arguments.text("--series");
  request.surface.labels = arguments.has("--labels");
  request.asked = arguments.has("--iso") || arguments.has("--raw") || request.surface.labels;
  if (arguments.has("--iso")) {
    const std::string text = arguments.text("--iso");
    const std::optional<double> iso = parse_number(text);
    if (!iso) return bad_value("--iso", text, "use a number, with a point before decimals");
    if (request.surface.labels) {
      return fail(ErrorCode::bad_argument, "--iso and --labels exclude each other", {}, "choose one");
    }
    request.surface.iso = *iso;
  }
  if (arguments.has("--raw")) {
    Result<io::RawLayout> raw = raw_layout(arguments);
    LODESTONE_TRY(raw);
    request.read.raw = std::move(*raw);
  }
  LODESTONE_TRY(read_smoothing(arguments, request.surface));
  if (arguments.has("--scan-resolution")) {
    const Result<std::uint64_t> resolution = arguments.count("--scan-resolution", 8, 4096);
    LODESTONE_TRY(resolution);
    request.scan.resolution = static_cast<std::uint32_t>(*resolution);
  }
  request.scan.splat = arguments.has("--splat");
  if (arguments.has("--close")) {
    const Result<LengthRules> lengths = length_rules(arguments);
    LODESTONE_TRY(lengths);
    request.lengths = *lengths;
    Result<std::vector<LengthArgument>> close = length_list(arguments, "--close", *lengths);
    LODESTONE_TRY(close);
    if (close->size() != 1) return bad_value("--close", arguments.text("--close"), "use one radius, such as 1%");
    request.close = std::move(*close);
  }
  return request;
}

bool is_volume(const fs::path& path, const VolumeRequest& request) {
  return request.asked || io::is_volume_name(path) || io::is_volume_folder(path);
}

bool is_scan(const fs::path& path) {
  Result<InputFile> file = InputFile::open(path);
  if (!file) return false;
  std::string head(std::min<std::uint64_t>(file->size(), std::uint64_t{1} << 16), '\0');
  const Result<std::size_t> got = file->read(std::as_writable_bytes(std::span(head)));
  if (!got) return false;
  head.resize(*got);
  return io::looks_like_points(path, head);
}

Result<Model> read_scan_model(const fs::path& path, const VolumeRequest& request, Task task) {
  Result<PointCloud> cloud = io::read_points(path, task.part(0.2, "reading"));
  LODESTONE_TRY(cloud);
  chain::ScanSurfaceOptions options = request.scan;
  if (!request.close.empty()) {
    Model unit;
    unit.meters_per_unit = cloud->meters_per_unit;
    apply_unit(unit, request.lengths);
    const Result<std::vector<double>> radius = to_model_units(request.close, unit, bounds_of(*cloud).diagonal());
    LODESTONE_TRY(radius);
    options.close_radius = radius->front();
  }
  Result<chain::ScanSurface> surface = chain::surface_of_scan(std::move(*cloud), options, task.part(0.8));
  if (!surface) {
    Error error = surface.error();
    error.where = path.string();
    return fail(std::move(error));
  }
  surface->model.files = {path};
  surface->model.file_triangles = drawn_triangles(surface->model);
  return std::move(surface->model);
}

Result<Model> read_volume_model(const fs::path& path, const VolumeRequest& request, Task task) {
  const Result<ScannedVolume> volume = read_in_child(path, request, task.part(0.5, "reading"));
  LODESTONE_TRY(volume);
  Result<chain::VolumeSurface> surface = chain::surface_of(*volume, request.surface, task.part(0.5, "contouring"));
  if (!surface) {
    Error error = surface.error();
    if (error.where.empty()) error.where = path.string();
    return fail(std::move(error));
  }
  return std::move(surface->model);
}

}  // namespace lodestone::app
