// Method   Marching Cubes on a bit a voxel, see cube_surface.cpp; vertices where values, linear along edges, reach iso
#include "lodestone/voxel/isosurface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "lodestone/base/cpu.h"
#include "lodestone/base/parallel.h"
#include "lodestone/voxel/cube_surface_detail.h"
#include "lodestone/voxel/inside_rows_detail.h"

namespace lodestone::voxel {

using detail::InsideRows;

namespace {

// Bit k of the result: values[k] is above the limit. 64 values.
template <class T>
std::uint64_t above(const T* values, T limit) {
  std::uint64_t word = 0;
  for (std::uint32_t k = 0; k < 64; ++k) word |= std::uint64_t{values[k] > limit} << k;
  return word;
}

#ifdef __SSE2__
// Sixteen bytes at once.
std::uint64_t above(const std::uint8_t* values, std::uint8_t limit) {
  using Bytes = unsigned char __attribute__((vector_size(16)));
  using Signed = char __attribute__((vector_size(16)));
  const Bytes most = Bytes{} + limit;
  std::uint64_t word = 0;
  for (std::uint32_t k = 0; k < 64; k += 16) {
    Bytes v;
    std::memcpy(&v, values + k, 16);
    const auto mask = static_cast<std::uint32_t>(__builtin_ia32_pmovmskb128(reinterpret_cast<Signed>(v > most)));
    word |= std::uint64_t{mask} << k;
  }
  return word;
}
#endif

// The bits of a row of voxels, one place on for the layer before them.
template <class T>
void set_row(const T* values, std::uint32_t count, T limit, std::uint64_t* bits, std::size_t words) {
  std::uint64_t carried = 0;
  std::uint32_t x = 0;
  std::size_t w = 0;
  for (; x + 64 <= count; x += 64, ++w) {
    const std::uint64_t word = above(values + x, limit);
    bits[w] = word << 1 | carried;
    carried = word >> 63;
  }
  std::uint64_t rest = 0;
  for (std::uint32_t k = 0; x + k < count; ++k) rest |= std::uint64_t{values[x + k] > limit} << k;
  bits[w] = rest << 1 | carried;
  if (w + 1 < words) bits[w + 1] = rest >> 63;
}

template <class T>
InsideRows inside_rows(const VolumeView<T>& volume, double iso, const Task& task) {
  const auto& size = volume.grid.size;
  InsideRows rows(size[0], size[1], size[2]);
  // For whole numbers v > iso is v > floor(iso), which needs no conversion. Where that is below the least, all are
  // inside.
  constexpr bool kWhole = !std::is_floating_point_v<T>;
  if (kWhole && iso >= static_cast<double>(std::numeric_limits<T>::max())) return rows;
  const bool all = kWhole && iso < static_cast<double>(std::numeric_limits<T>::lowest());
  const T limit = all ? T{0} : static_cast<T>(kWhole ? std::floor(iso) : iso);
  const std::vector<T> ones(all ? size[0] : 0, T{1});
  parallel_for(size[2], 1, task, [&](std::size_t z, std::size_t, std::size_t) {
    for (std::uint32_t y = 0; y < size[1]; ++y) {
      const T* values = all ? ones.data() : volume.values.data() + volume.index(0, y, static_cast<std::uint32_t>(z));
      set_row(values, size[0], limit, rows.bits(rows.row(y + 1, static_cast<std::uint32_t>(z) + 1)), rows.row_words);
    }
  });
  return rows;
}

// Where along the edge from a voxel to the next the values reach iso; half way to what lies outside of the volume.
template <class T>
double share_between(const VolumeView<T>& volume, const std::array<std::uint32_t, 3>& padded, std::size_t axis,
                     double iso) {
  std::array<std::uint32_t, 3> next = padded;
  ++next[axis];
  const auto& size = volume.grid.size;
  if (padded[axis] == 0 || next[axis] > size[axis]) return 0.5;
  const auto a = static_cast<double>(volume.at(padded[0] - 1, padded[1] - 1, padded[2] - 1));
  const auto b = static_cast<double>(volume.at(next[0] - 1, next[1] - 1, next[2] - 1));
  const double share = (iso - a) / (b - a);
  return share >= 0 && share <= 1 ? share : 0.5;  // not finite
}

template <class T>
Result<Mesh> surface_of(const VolumeView<T>& volume, const IsosurfaceOptions& options, const Task& task) {
  const auto& size = volume.grid.size;
  if (!std::isfinite(options.iso)) return fail(ErrorCode::bad_argument, "the iso value is not a finite number");
  if (volume.values.size() != volume.grid.count() || volume.grid.count() == 0 ||
      *std::max_element(size.begin(), size.end()) > 65'535) {
    return fail(ErrorCode::bad_argument, fmt::format("{} values are no volume of {} x {} x {} voxels",
                                                     volume.values.size(), size[0], size[1], size[2]));
  }
  const InsideRows rows = inside_rows(volume, options.iso, task);
  const Result<detail::CubeSurface> surface = detail::find_surface(rows, task);
  if (!surface) return fail(surface.error());
  if (surface->vertices == 0) {
    return fail(ErrorCode::empty, fmt::format("no voxel is above {}", options.iso), {}, "choose another iso value");
  }
  Mesh mesh;
  detail::place_vertices(volume.grid, rows, *surface, mesh, task,
                         [&](std::size_t axis, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
                           return share_between(volume, {x, y, z}, axis, options.iso);
                         });
  detail::make_triangles(rows, *surface, mesh, task);
  if (task.cancelled()) return cancelled_error("contouring");
  return mesh;
}

}  // namespace

Result<Mesh> isosurface(const VolumeView<std::uint8_t>& volume, const IsosurfaceOptions& options, Task task) {
  return surface_of(volume, options, task);
}
Result<Mesh> isosurface(const VolumeView<std::int16_t>& volume, const IsosurfaceOptions& options, Task task) {
  return surface_of(volume, options, task);
}
Result<Mesh> isosurface(const VolumeView<std::uint16_t>& volume, const IsosurfaceOptions& options, Task task) {
  return surface_of(volume, options, task);
}
Result<Mesh> isosurface(const VolumeView<float>& volume, const IsosurfaceOptions& options, Task task) {
  return surface_of(volume, options, task);
}

}  // namespace lodestone::voxel
