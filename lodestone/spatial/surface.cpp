#include "lodestone/spatial/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "lodestone/base/parallel.h"
#include "lodestone/core/validate.h"
#include "lodestone/spatial/hilbert.h"

namespace lodestone::spatial {

namespace {

constexpr std::size_t kChunk = std::size_t{1} << 15;

void append_instance(const Mesh& mesh, const Instance& instance, Surface& surface) {
  const auto first = static_cast<std::uint32_t>(surface.positions.size());
  const bool plain = instance.transform.is_identity();
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3d p = mesh.position(v);
    surface.positions.push_back(plain ? p : instance.transform.point(p));
  }
  const bool mirrored = instance.transform.determinant3() < 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle v = mesh.vertices_of(t);
    for (std::uint32_t& c : v) c += first;
    if (mirrored) std::swap(v[1], v[2]);
    surface.triangles.push_back(v);
  }
}

struct Key {
  std::uint64_t code;
  std::uint32_t triangle;
};

std::vector<Key> hilbert_keys(const Surface& surface, const Task& task) {
  std::vector<Key> keys(surface.triangles.size());
  const Vec3d size = surface.bounds.size(), low = surface.bounds.min;
  const double longest = std::max({size.x, size.y, size.z});
  const double cells = longest > 0 ? 65535.0 / longest : 0;
  parallel_for(keys.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto [a, b, c] = surface.corners(t);
      const Vec3d p = ((a + b + c) / 3.0 - low) * cells;
      // Written so that what is no number becomes 0.
      const auto cell = [](double x) { return static_cast<std::uint32_t>(x > 0 ? std::min(x, 65535.0) : 0.0); };
      keys[t] = {hilbert_key(cell(p.x), cell(p.y), cell(p.z)), static_cast<std::uint32_t>(t)};
    }
  });
  return keys;
}

void reorder(Surface& surface, const std::vector<Key>& keys) {
  std::vector<Triangle> triangles;
  triangles.reserve(keys.size());
  std::vector<std::uint32_t> name(surface.positions.size(), kNone);
  std::vector<Vec3d> positions;
  positions.reserve(surface.positions.size());
  surface.drawn.reserve(keys.size());
  for (const Key& key : keys) {
    Triangle t = surface.triangles[key.triangle];
    for (std::uint32_t& v : t) {
      if (name[v] == kNone) {
        name[v] = static_cast<std::uint32_t>(positions.size());
        positions.push_back(surface.positions[v]);
      }
      v = name[v];
    }
    triangles.push_back(t);
    surface.drawn.push_back(key.triangle);
  }
  surface.triangles = std::move(triangles);
  surface.positions = std::move(positions);
}

}  // namespace

Result<Surface> flatten(const Model& model, Task task) { return flatten(model, Input::unchecked, std::move(task)); }

Result<Surface> flatten(const Model& model, Input input, Task task) {
  if (input != Input::valid) {
    LODESTONE_TRY(validate(model, task));
  }
  Surface surface;
  const std::size_t triangles = drawn_triangles(model);
  std::size_t vertices = 0;
  for (const Instance& instance : model.instances) vertices += model.meshes[instance.mesh].vertex_count();
  if (triangles == 0) return fail(ErrorCode::empty, "the model draws no triangle");
  if (vertices > kNone - 1 || triangles > kNone / 3) {
    return fail(ErrorCode::unsupported, "the scene draws more triangles than can be measured at once");
  }
  surface.positions.reserve(vertices);
  surface.triangles.reserve(triangles);
  for (const Instance& instance : model.instances) append_instance(model.meshes[instance.mesh], instance, surface);
  for (const Triangle& t : surface.triangles) {
    for (const std::uint32_t v : t) surface.bounds.add(surface.positions[v]);
  }
  std::vector<Key> keys = hilbert_keys(surface, task);
  parallel_sort(keys, task, [](const Key& a, const Key& b) { return a.code < b.code; });
  if (task.cancelled()) return cancelled_error("measuring");
  reorder(surface, keys);
  return surface;
}

Result<void> validate(const Surface& surface, const Task& task) {
  const std::size_t none = std::max(surface.positions.size(), surface.triangles.size());
  const auto first_of = [&](std::size_t n, const auto& is_bad) {
    const auto in_chunk = [&](std::size_t begin, std::size_t end) {
      while (begin < end && !is_bad(begin)) ++begin;
      return begin < end ? begin : none;
    };
    return parallel_reduce(n, kChunk, task, none, in_chunk, [](auto a, auto b) { return std::min(a, b); });
  };
  const std::size_t v = first_of(surface.positions.size(), [&](std::size_t i) {
    const Vec3d p = surface.positions[i];
    return !(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= kMostCoordinate) || !is_finite(p);
  });
  if (v < none) {
    return fail(ErrorCode::bad_argument,
                fmt::format("position {} is not finite or farther than {:g} from the origin", v, kMostCoordinate),
                "surface");
  }
  const std::size_t positions = surface.positions.size();
  const std::size_t t = first_of(surface.triangles.size(), [&](std::size_t i) {
    const Triangle& corners = surface.triangles[i];
    return std::max({corners[0], corners[1], corners[2]}) >= positions;
  });
  if (t < none) {
    const Triangle& corners = surface.triangles[t];
    return fail(ErrorCode::bad_argument,
                fmt::format("triangle {} names position {} of {}", t, std::max({corners[0], corners[1], corners[2]}),
                            positions),
                "surface");
  }
  if (task.cancelled()) return cancelled_error("validating");
  return {};
}

}  // namespace lodestone::spatial
