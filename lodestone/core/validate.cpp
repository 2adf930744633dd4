// Checks what must hold for meshes, models, ladders, points, volumes and collapse logs; validate.h says what that is.
//
// Problem: files and hand-made structures may hold anything, and an index out of range or a coordinate that is no
// number would crash or mislead whatever comes after. So they are looked at once, before any work.
// 1. first_bad(): the first of n elements that breaks a rule. A chunk is passed over without a branch an element; only
//    where it holds an offender is that one looked for.
// 2. check_places(), check_wedges(), check_groups(), check_streams(): the parts of a mesh. check_materials(),
//    check_instances(), check_model(): those of a model.
// 3. validate(): one for each structure. The one for a log asks whether it can be a log of its mesh.
// Invariants: nothing is changed. The error names the first offender and the limit, whatever the thread count; a
// cancelled task ends in an error, never in "valid". Cost: O(size).
#include "lodestone/core/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "lodestone/base/parallel.h"

namespace lodestone {

namespace {

constexpr std::size_t kChunk = std::size_t{1} << 16;

template <class... Args>
tl::unexpected<Error> bad(std::string where, fmt::format_string<Args...> text, Args&&... args) {
  return fail(ErrorCode::bad_argument, fmt::format(text, std::forward<Args>(args)...), std::move(where));
}

// The first of n elements that is bad; n if none is. A chunk is first asked whether it has any, without a branch an
// element. After a cancelled task the answer means nothing.
template <class Bad>
std::size_t first_bad(std::size_t n, const Task& task, const Bad& is_bad) {
  const auto in_chunk = [&](std::size_t begin, std::size_t end) {
    bool any = false;
    for (std::size_t i = begin; i < end; ++i) any |= is_bad(i);
    if (!any) return n;
    while (!is_bad(begin)) ++begin;
    return begin;
  };
  if (n <= kChunk) return in_chunk(0, n);
  return parallel_reduce(n, kChunk, task, n, in_chunk, [](std::size_t a, std::size_t b) { return std::min(a, b); });
}

// x - x is 0 for finite x and NaN for all others.
bool is_not_finite(Vec3f p) { return !((p.x - p.x) + (p.y - p.y) + (p.z - p.z) == 0); }

std::size_t first_infinite(const std::vector<Vec3f>& positions, const Task& task) {
  return first_bad(positions.size(), task, [&](std::size_t v) { return is_not_finite(positions[v]); });
}

std::string label(std::string_view kind, std::size_t number, const std::string& name) {
  return name.empty() ? fmt::format("{} {}", kind, number) : fmt::format("{} {} ({})", kind, number, name);
}

Result<void> check_places(const Mesh& mesh, const std::string& where, const Task& task) {
  if (!is_finite(mesh.offset)) return bad(where, "the offset is not finite");
  if (const std::size_t v = first_infinite(mesh.positions, task); v < mesh.positions.size()) {
    return bad(where, "vertex {} of {} has a coordinate that is not finite", v, mesh.positions.size());
  }
  return {};
}

Result<void> check_wedges(const Mesh& mesh, const std::string& where, const Task& task) {
  const std::size_t vertices = mesh.positions.size(), wedges = mesh.wedge_count(), triangles = mesh.triangles.size();
  const std::vector<std::uint32_t>& vertex = mesh.wedge_vertex;
  if (const std::size_t w = first_bad(vertex.size(), task, [&](std::size_t i) { return vertex[i] >= vertices; });
      w < vertex.size()) {
    return bad(where, "wedge {} names vertex {} of {}", w, vertex[w], vertices);
  }
  const auto is_bad = [&](std::size_t i) {
    const Triangle& t = mesh.triangles[i];
    return std::max({t[0], t[1], t[2]}) >= wedges;
  };
  if (const std::size_t t = first_bad(triangles, task, is_bad); t < triangles) {
    const Triangle& corners = mesh.triangles[t];
    const std::uint32_t wedge = *std::find_if(corners.begin(), corners.end(), [&](auto w) { return w >= wedges; });
    return bad(where, "triangle {} names wedge {} of {}", t, wedge, wedges);
  }
  return {};
}

Result<void> check_groups(const Mesh& mesh, const std::string& where, const Task& task) {
  const std::size_t groups = std::max<std::size_t>(1, mesh.groups.size());
  const std::vector<std::uint32_t>& group = mesh.face_group;
  if (!group.empty() && group.size() != mesh.triangles.size()) {
    return bad(where, "there are {} face groups for {} triangles", group.size(), mesh.triangles.size());
  }
  if (const std::size_t t = first_bad(group.size(), task, [&](std::size_t i) { return group[i] >= groups; });
      t < group.size()) {
    return bad(where, "triangle {} names group {} of {}", t, group[t], groups);
  }
  return {};
}

Result<void> check_streams(const Mesh& mesh, const std::string& where) {
  const std::size_t wedges = mesh.wedge_count(), groups = std::max<std::size_t>(1, mesh.groups.size());
  for (const AttributeStream& stream : mesh.attributes) {
    if (stream.components == 0 || stream.value_count() != wedges * stream.components) {
      return bad(where, "attribute {} has {} values for {} wedges of {}", stream.name, stream.value_count(), wedges,
                 stream.components);
    }
    if (!stream.present.empty() && stream.present.size() != groups) {
      return bad(where, "attribute {} has {} presence marks for {} groups", stream.name, stream.present.size(), groups);
    }
  }
  return {};
}

Result<void> check_indices(const Mesh& mesh, const std::string& where, const Task& task) {
  constexpr std::size_t kLimit = kNone - 1;
  if (mesh.positions.size() > kLimit || mesh.wedge_count() > kLimit || mesh.triangles.size() > kLimit / 3) {
    return bad(where, "{} vertices, {} wedges, {} triangles are more than 32-bit indices can name",
               mesh.positions.size(), mesh.wedge_count(), mesh.triangles.size());
  }
  LODESTONE_TRY(check_wedges(mesh, where, task));
  LODESTONE_TRY(check_groups(mesh, where, task));
  return check_streams(mesh, where);
}

Result<void> check_mesh(const Mesh& mesh, const std::string& where, const Task& task) {
  LODESTONE_TRY(check_places(mesh, where, task));
  LODESTONE_TRY(check_indices(mesh, where, task));
  if (task.cancelled()) return cancelled_error("validating");  // then chunks were left out
  return {};
}

Result<void> check_materials(const Model& model, const std::string& before) {
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    const auto& pixels = model.materials[i].base_color_pixels;
    const Result<void> ok = pixels != nullptr ? validate(*pixels) : Result<void>{};
    if (!ok) return bad(before + label("material", i, model.materials[i].name), "its {}", ok.error().what);
  }
  return {};
}

// How far from the origin a mesh with such an offset can come to lie along any axis, whatever its positions (floats).
double farthest(const Mat4d& transform, Vec3d offset) {
  constexpr auto kMostFloat = static_cast<double>(std::numeric_limits<float>::max());
  const Vec3d most{kMostFloat + std::abs(offset.x), kMostFloat + std::abs(offset.y), kMostFloat + std::abs(offset.z)};
  double out = 0;
  for (std::size_t row = 0; row < 3; ++row) {
    double sum = std::abs(transform.m[12 + row]);
    for (std::size_t column = 0; column < 3; ++column) sum += std::abs(transform.m[column * 4 + row]) * most[column];
    out = std::max(out, sum);
  }
  return out;
}

Result<void> check_instances(const Model& model, const std::string& before) {
  for (std::size_t i = 0; i < model.instances.size(); ++i) {
    const Instance& instance = model.instances[i];
    const auto where = [&] { return before + label("instance", i, instance.name); };
    if (instance.mesh >= model.meshes.size()) {
      return bad(where(), "it names mesh {} of {}", instance.mesh, model.meshes.size());
    }
    const auto& m = instance.transform.m;
    if (!std::all_of(m.begin(), m.end(), [](double x) { return std::isfinite(x); })) {
      return bad(where(), "its transform is not finite");
    }
    if (!(farthest(instance.transform, model.meshes[instance.mesh].offset) <= kMostCoordinate)) {
      return bad(where(), "it may lie farther from the origin than {:g}", kMostCoordinate);
    }
  }
  return {};
}

Result<void> check_model(const Model& model, const std::string& before, const Task& task) {
  for (std::size_t i = 0; i < model.meshes.size(); ++i) {
    const Mesh& mesh = model.meshes[i];
    const std::string where = before + label("mesh", i, mesh.name);
    LODESTONE_TRY(check_mesh(mesh, where, task));
    for (const FaceGroup& group : mesh.groups) {
      if (group.material == kNone || model.materials.empty() || group.material < model.materials.size()) continue;
      return bad(where, "group {} names material {} of {}", &group - mesh.groups.data(), group.material,
                 model.materials.size());
    }
  }
  LODESTONE_TRY(check_materials(model, before));
  return check_instances(model, before);
}

}  // namespace

Result<void> validate(const Mesh& mesh, const Task& task) {
  return check_mesh(mesh, mesh.name.empty() ? "mesh" : mesh.name, task);
}

Result<void> validate_indices(const Mesh& mesh, const Task& task) {
  LODESTONE_TRY(check_indices(mesh, mesh.name.empty() ? "mesh" : mesh.name, task));
  if (task.cancelled()) return cancelled_error("validating");
  return {};
}

Result<void> validate(const Model& model, const Task& task) { return check_model(model, {}, task); }

Result<void> validate(const Ladder& ladder, const Task& task) {
  if (ladder.levels.empty()) return bad("ladder", "it has no levels; the first is the original itself");
  if (const Result<void> ok = check_model(ladder.original, {}, task); !ok) return ok;
  for (std::size_t level = 1; level < ladder.levels.size(); ++level) {
    const Result<void> ok = check_model(ladder.levels[level].model, fmt::format("level {}, ", level), task);
    if (!ok) return ok;
  }
  return {};
}

Result<void> validate(const Pixels& pixels) {
  const std::size_t count = std::size_t{pixels.width} * pixels.height;  // four times that might not fit
  if (pixels.rgba.size() % 4 == 0 && pixels.rgba.size() / 4 == count) return {};
  return bad({}, "picture of {} x {} pixels has {} bytes", pixels.width, pixels.height, pixels.rgba.size());
}

Result<void> validate(const PointCloud& cloud, const Task& task) {
  const std::size_t points = cloud.size();
  if (points > kNone - 1) return bad("points", "{} points are more than 32-bit indices can name", points);
  if (!is_finite(cloud.offset)) return bad("points", "the offset is not finite");
  if (!cloud.normals.empty() && cloud.normals.size() != points) {
    return bad("points", "there are {} normals for {} points", cloud.normals.size(), points);
  }
  if (!cloud.colors.empty() && cloud.colors.size() != points) {
    return bad("points", "there are {} colours for {} points", cloud.colors.size(), points);
  }
  if (const std::size_t p = first_infinite(cloud.positions, task); p < points) {
    return fail(ErrorCode::bad_argument, fmt::format("point {} of {} has a coordinate that is not finite", p, points),
                "points", "leave it out");
  }
  if (task.cancelled()) return cancelled_error("validating");
  return {};
}

Result<void> validate(const VoxelGrid& grid) {
  if (!is_finite(grid.origin)) return bad("volume", "its origin is not finite");
  const auto is_length = [](double x) { return x > 0 && std::isfinite(x); };
  if (!is_length(grid.spacing.x) || !is_length(grid.spacing.y) || !is_length(grid.spacing.z)) {
    return bad("volume", "voxels of {} x {} x {}: sides must be above 0 and finite", grid.spacing.x, grid.spacing.y,
               grid.spacing.z);
  }
  const std::uint64_t slice = std::uint64_t{grid.size[0]} * grid.size[1];
  if (slice != 0 && grid.size[2] > std::numeric_limits<std::uint64_t>::max() / slice) {
    return bad("volume", "{} x {} x {} voxels are too many", grid.size[0], grid.size[1], grid.size[2]);
  }
  return {};
}

Result<void> validate(const BitVolume& volume) {
  LODESTONE_TRY(validate(volume.grid));
  const auto& size = volume.grid.size;
  const std::size_t row = (std::size_t{size[0]} + 63) / 64;
  if (volume.row_words == row && volume.words.size() == row * size[1] * size[2]) return {};
  return bad("volume", "{} words in rows of {} for {} x {} x {} voxels, which need {} in rows of {}",
             volume.words.size(), volume.row_words, size[0], size[1], size[2], row * size[1] * size[2], row);
}

Result<void> validate(const VoxelGrid& grid, std::uint64_t values) {
  LODESTONE_TRY(validate(grid));
  if (values >= grid.count()) return {};
  return bad("volume", "{} values for {} x {} x {} voxels", values, grid.size[0], grid.size[1], grid.size[2]);
}

Result<void> validate(const ScannedVolume& volume) {
  const VolumeHeader& header = volume.header;
  const std::size_t values = std::visit([](const auto& v) { return v.size(); }, volume.values);
  LODESTONE_TRY(validate(header.grid, values));
  const auto finite = [](double x) { return std::isfinite(x); };
  const auto& m = header.to_world.m;
  if (!std::all_of(m.begin(), m.end(), finite)) return bad("volume", "its transform is not finite");
  const std::vector<double>& slices = header.slice_positions;
  if (!slices.empty() && slices.size() != header.grid.size[2]) {
    return bad("volume", "there are {} slice positions for {} slices", slices.size(), header.grid.size[2]);
  }
  if (!std::all_of(slices.begin(), slices.end(), finite)) return bad("volume", "a slice position is not finite");
  if (!std::is_sorted(slices.begin(), slices.end())) return bad("volume", "the slice positions do not rise");
  return {};
}

Result<void> validate(const CollapseLog& log, const Mesh& mesh, const Task& task) {
  const std::string where = "collapse log";
  const std::size_t vertices = mesh.vertex_count(), wedges = mesh.wedge_count(), triangles = mesh.triangles.size();
  const auto& collapses = log.collapses;
  const auto is_bad = [&](std::size_t i) {
    const Collapse& c = collapses[i];
    const std::size_t last = i + 1 < collapses.size() ? collapses[i + 1].first_wedge : log.wedges.size();
    return std::max(c.kept, c.removed) >= vertices || c.kept == c.removed || c.first_wedge > last ||
           last > log.wedges.size() || is_not_finite(c.position);
  };
  if (const std::size_t i = first_bad(collapses.size(), task, is_bad); i < collapses.size()) {
    const Collapse& c = collapses[i];
    return bad(where, "collapse {} of vertices {} and {} of {}, wedges from {} of {}, does not fit or is not finite", i,
               c.kept, c.removed, vertices, c.first_wedge, log.wedges.size());
  }
  const auto names_other = [&](std::size_t i) { return std::max(log.wedges[i].kept, log.wedges[i].removed) >= wedges; };
  if (const std::size_t i = first_bad(log.wedges.size(), task, names_other); i < log.wedges.size()) {
    return bad(where, "merge {} names wedge {} of {}", i, std::max(log.wedges[i].kept, log.wedges[i].removed), wedges);
  }
  const auto blends_wrongly = [&](std::size_t i) { return !(log.wedges[i].blend >= 0 && log.wedges[i].blend <= 1); };
  if (const std::size_t i = first_bad(log.wedges.size(), task, blends_wrongly); i < log.wedges.size()) {
    return bad(where, "merge {} blends by {}, which is not from 0 to 1", i, log.wedges[i].blend);
  }
  for (const std::uint32_t t : log.dropped) {
    if (t >= triangles) return bad(where, "it leaves out triangle {} of {}", t, triangles);
  }
  std::uint64_t gone = 0;
  for (const Collapse& c : collapses) gone += c.faces;
  if (gone > log.start_triangles || log.start_triangles > triangles) {
    return bad(where, "{} triangles vanish of {} at the start, the mesh has {}", gone, log.start_triangles, triangles);
  }
  if (task.cancelled()) return cancelled_error("validating");
  return {};
}

}  // namespace lodestone
