#include "lodestone/core/validate.h"

#include <fmt/format.h>

#include <algorithm>

namespace lodestone {

namespace {

template <class... Args>
tl::unexpected<Error> bad(const Mesh& mesh, fmt::format_string<Args...> text, Args&&... args) {
  return fail(ErrorCode::bad_format, fmt::format(text, std::forward<Args>(args)...), mesh.name);
}

// x * 0 is 0 for finite x and NaN for all others, and a NaN stays in the sum.
bool all_finite(const std::vector<Vec3f>& positions) {
  Vec3f sum{};
  for (const Vec3f& p : positions) sum = {sum.x + p.x * 0, sum.y + p.y * 0, sum.z + p.z * 0};
  return is_finite(sum);
}

// 0 for no triangles at all.
std::uint32_t largest_wedge(const std::vector<Triangle>& triangles) {
  Triangle most{};
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) most[k] = std::max(most[k], t[k]);
  }
  return std::max({most[0], most[1], most[2]});
}

}  // namespace

Result<void> validate(const Mesh& mesh) {
  constexpr std::size_t kLimit = kNone - 1;
  if (mesh.positions.size() > kLimit || mesh.wedge_count() > kLimit || mesh.triangles.size() > kLimit / 3) {
    return bad(mesh, "{} vertices, {} wedges, {} triangles are more than 32-bit indices can name",
               mesh.positions.size(), mesh.wedge_count(), mesh.triangles.size());
  }
  if (!is_finite(mesh.offset)) return bad(mesh, "the offset is not finite");
  // Whether anything is wrong is asked without a branch an element, and where it is only then.
  if (!all_finite(mesh.positions)) {
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      if (!is_finite(mesh.positions[v])) return bad(mesh, "vertex {} has a coordinate that is not finite", v);
    }
  }
  for (std::size_t w = 0; w < mesh.wedge_vertex.size(); ++w) {
    if (mesh.wedge_vertex[w] >= mesh.positions.size()) {
      return bad(mesh, "wedge {} names vertex {} of {}", w, mesh.wedge_vertex[w], mesh.positions.size());
    }
  }
  const std::size_t wedges = mesh.wedge_count();
  if (!mesh.triangles.empty() && largest_wedge(mesh.triangles) >= wedges) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (const std::uint32_t w : mesh.triangles[t]) {
        if (w >= wedges) return bad(mesh, "triangle {} names wedge {} of {}", t, w, wedges);
      }
    }
  }
  const std::size_t groups = std::max<std::size_t>(1, mesh.groups.size());
  if (!mesh.face_group.empty() && mesh.face_group.size() != mesh.triangles.size()) {
    return bad(mesh, "{} face groups for {} triangles", mesh.face_group.size(), mesh.triangles.size());
  }
  for (const std::uint32_t g : mesh.face_group) {
    if (g >= groups) return bad(mesh, "a face names group {} of {}", g, groups);
  }
  for (const AttributeStream& stream : mesh.attributes) {
    if (stream.components == 0 || stream.value_count() != wedges * stream.components) {
      return bad(mesh, "attribute {} has {} values for {} wedges of {}", stream.name, stream.value_count(), wedges,
                 stream.components);
    }
    if (!stream.present.empty() && stream.present.size() != groups) {
      return bad(mesh, "attribute {} has {} presence marks for {} groups", stream.name, stream.present.size(), groups);
    }
  }
  return {};
}

Result<void> validate(const Model& model) {
  for (const Mesh& mesh : model.meshes) {
    if (const Result<void> ok = validate(mesh); !ok) return ok;
    for (const FaceGroup& group : mesh.groups) {
      if (group.material != kNone && !model.materials.empty() && group.material >= model.materials.size()) {
        return bad(mesh, "a group names material {} of {}", group.material, model.materials.size());
      }
    }
  }
  for (const Instance& instance : model.instances) {
    if (instance.mesh >= model.meshes.size()) {
      return fail(ErrorCode::bad_format,
                  fmt::format("an instance names mesh {} of {}", instance.mesh, model.meshes.size()), instance.name);
    }
    for (const double x : instance.transform.m) {
      if (!std::isfinite(x)) return fail(ErrorCode::bad_format, "its transform is not finite", instance.name);
    }
  }
  return {};
}

}  // namespace lodestone
