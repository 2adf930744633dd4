// From a scanner's volume of voxels to a model.
//
// surface_of():
// 1. range_of(): the smallest and largest value, and how many voxels hold no number.
// 2. Without labels, choose_iso() takes the threshold that is asked for, or Otsu's [otsu-1979], which separates two
//    classes of values best. filtered_contour() filters the values (median, Gaussian) where that is asked for, and
//    contours them by Marching Cubes [lorensen-cline-1987] in the grid's own frame.
//    With labels, add_labels() finds the boxes of all labels in one pass and contours a mask of each box half way.
// 3. to_world() (called by contour()) moves the vertices to the frame of the patient or the file. Slices that are
//    unevenly spaced or tilted come to lie where they belong (Placing); triangles of mirrored frames are turned.
//
// Contouring in the grid's frame keeps surfaces closed whatever the placing is. The volume is never changed. The same
// bytes for any number of threads. O(voxels), and for labels O(voxels of all their boxes).
#include "lodestone/chain/voxels/volume_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/base/units.h"
#include "lodestone/core/validate.h"
#include "lodestone/voxel/filter.h"
#include "lodestone/voxel/isosurface.h"
#include "lodestone/voxel/labels.h"
#include "lodestone/voxel/otsu.h"

namespace lodestone::chain {

namespace {

constexpr std::size_t kVoxelsAtOnce = std::size_t{1} << 20;

struct Range {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  std::uint64_t no_numbers = 0;  // NaN or infinite
};

template <class T>
Range range_of(std::span<const T> values, const Task& task) {
  return parallel_reduce(
      values.size(), kVoxelsAtOnce, task, Range{},
      [&](std::size_t begin, std::size_t end) {
        Range r;
        for (std::size_t i = begin; i < end; ++i) {
          const auto v = static_cast<double>(values[i]);
          if (!std::isfinite(v)) {
            ++r.no_numbers;
            continue;
          }
          r.least = std::min(r.least, v);
          r.most = std::max(r.most, v);
        }
        return r;
      },
      [](const Range& a, const Range& b) {
        return Range{std::min(a.least, b.least), std::max(a.most, b.most), a.no_numbers + b.no_numbers};
      });
}

// From the grid's frame, where slices are evenly spaced, to the world.
class Placing {
 public:
  explicit Placing(const VolumeHeader& header) : header_(header) {}
  Vec3d operator()(Vec3d p) const {
    const std::vector<double>& places = header_.slice_positions;
    if (!places.empty()) p.z = place(p.z / header_.grid.spacing.z, places);
    return header_.to_world.point(p);
  }
  bool mirrors() const { return header_.to_world.determinant3() < 0; }

 private:
  static double place(double slice, const std::vector<double>& places) {
    const double last = static_cast<double>(places.size() - 1);
    const double below = std::clamp(std::floor(slice), 0.0, last - 1);
    const auto i = static_cast<std::size_t>(below);
    return places[i] + (slice - below) * (places[i + 1] - places[i]);
  }
  const VolumeHeader& header_;
};

void to_world(const VolumeHeader& header, Mesh& mesh, const Task& task) {
  const Placing place(header);
  const Vec3d centre = mesh.offset;
  mesh.offset = place(centre);
  parallel_for(mesh.positions.size(), 1 << 14, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t v = begin; v < end; ++v) {
      mesh.positions[v] = to_float(place(to_double(mesh.positions[v]) + centre) - mesh.offset);
    }
  });
  if (!place.mirrors()) return;
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

// The surface of values on a grid in a volume's frame, moved to the world.
template <class T>
Result<Mesh> contour(const VolumeHeader& frame, const VolumeView<T>& values, const voxel::IsosurfaceOptions& options,
                     const Task& task) {
  Result<Mesh> mesh = voxel::isosurface(values, options, task);
  if (mesh) to_world(frame, *mesh, task);
  return mesh;
}

// Standard deviations in voxels.
Vec3d blur_of(const VolumeSurfaceOptions& options, const VoxelGrid& grid) {
  const Vec3d each = options.smooth_in_voxels ? Vec3d{1, 1, 1} : grid.spacing;
  return {options.smooth / each.x, options.smooth / each.y, options.smooth / each.z};
}

template <class T>
Result<void> add_labels(const ScannedVolume& volume, std::span<const T> values, const VolumeSurfaceOptions& options,
                        Model& model, const Task& task) {
  const VolumeView<T> view{volume.header.grid, values};
  const Result<std::map<std::int64_t, voxel::LabelBox>> boxes = voxel::label_boxes(view, task);
  LODESTONE_TRY(boxes);
  if (boxes->empty()) return fail(ErrorCode::empty, "has no label but 0");
  for (const auto& [label, box] : *boxes) {
    if (task.cancelled()) return cancelled_error("contouring");
    ScalarVolume<std::uint8_t> mask = voxel::label_mask(view, box, label);
    Result<Mesh> mesh = contour(volume.header, mask.view(), {127.5}, task);
    if (options.smooth > 0) {
      const Vec3d sigma = blur_of(options, mask.grid);
      const auto soft = voxel::gaussian(voxel::padded(mask, voxel::gaussian_reach(sigma)), sigma, task);
      LODESTONE_TRY(soft);
      Result<Mesh> smoothed = contour(volume.header, soft->view(), {127.5}, task);
      if (smoothed) mesh = std::move(smoothed);  // a label of a few voxels may blur away: it is not smoothed then
    }
    LODESTONE_TRY(mesh);
    mesh->name = fmt::format("label {}", label);
    mesh->groups.push_back({kNone, mesh->name});
    model.instances.push_back({static_cast<std::uint32_t>(model.meshes.size()), {}, mesh->name});
    model.meshes.push_back(std::move(*mesh));
  }
  return {};
}

template <class T>
Result<Mesh> filtered_contour(const VolumeHeader& header, std::span<const T> values, double iso,
                              const VolumeSurfaceOptions& options, const Task& task) {
  const VolumeView<T> view{header.grid, values};
  if (!options.median && !(options.smooth > 0)) return contour(header, view, {iso, options.trilinear}, task);
  Result<ScalarVolume<float>> made = options.median ? voxel::median(view, 1, task) : voxel::as_float(view, task);
  if (made && options.smooth > 0) {
    made = voxel::gaussian(std::move(*made), blur_of(options, header.grid), task);
  }
  LODESTONE_TRY(made);
  return contour(header, made->view(), {iso, options.trilinear}, task);
}

// Patients lie in LPS; glTF wants Y up (superior) and Z forward (anterior).
Mat4d lps_to_gltf() {
  Mat4d m;
  m.m = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
  return m;
}

Result<double> choose_iso(const VolumeSurfaceOptions& options, const VolumeValues& values, const Range& range,
                          std::vector<std::string>& warnings) {
  if (!(range.most > range.least)) {
    return fail(ErrorCode::empty, fmt::format("all values are {}: there is no surface", range.least));
  }
  if (!options.iso) {
    const double iso = voxel::otsu_threshold(values, range.least, range.most);
    warnings.push_back(fmt::format("the surface is that at {} of {} to {} (Otsu's threshold); choose with `iso`",
                                   short_number(iso), short_number(range.least), short_number(range.most)));
    return iso;
  }
  if (*options.iso >= range.least && *options.iso < range.most) return *options.iso;
  return fail(ErrorCode::bad_argument,
              fmt::format("the iso value {} is outside of the volume's values, {} to {}", *options.iso,
                          short_number(range.least), short_number(range.most)),
              {}, "choose one between them");
}

}  // namespace

Result<VolumeSurface> surface_of(const ScannedVolume& volume, const VolumeSurfaceOptions& options, Task task) {
  LODESTONE_TRY(validate(volume));
  VolumeSurface out;
  const Range range = std::visit([&](const auto& values) { return range_of(values, task); }, volume.values);
  if (task.cancelled()) return cancelled_error("contouring");
  if (!(range.least <= range.most)) {
    return fail(ErrorCode::bad_format, "none of the volume's values is a number");
  }
  out.least = range.least;
  out.most = range.most;
  Model& model = out.model;
  model.warnings = volume.header.warnings;
  if (range.no_numbers > 0) {
    model.warnings.push_back(
        fmt::format("{} voxels hold no number and count as outside", with_separators(range.no_numbers)));
  }
  if (options.labels) {
    const Result<void> added =
        std::visit([&](const auto& values) { return add_labels(volume, values, options, model, task); }, volume.values);
    LODESTONE_TRY(added);
  } else {
    const Result<double> iso = choose_iso(options, volume.values, range, model.warnings);
    LODESTONE_TRY(iso);
    out.iso = *iso;
    Result<Mesh> mesh =
        std::visit([&](const auto& values) { return filtered_contour(volume.header, values, *iso, options, task); },
                   volume.values);
    LODESTONE_TRY(mesh);
    Model made = make_model(std::move(*mesh));
    model.meshes = std::move(made.meshes);
    model.instances = std::move(made.instances);
  }
  model.meters_per_unit = volume.header.meters_per_unit;
  if (volume.header.patient_axes) model.gltf_axes = lps_to_gltf();
  model.files = volume.header.files;
  model.file_triangles = drawn_triangles(model);
  for (const Mesh& mesh : model.meshes) model.file_vertices += mesh.positions.size();
  return out;
}

}  // namespace lodestone::chain
