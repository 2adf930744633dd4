// The surface at which the values of a volume pass an iso value.
//
// Method: Marching Cubes (W. Lorensen and H. Cline, 1987 [lorensen-cline-1987]) in two parts. Which edges are crossed
// and which cubes are cut follows from one bit a voxel and is found by cube_surface.cpp; this file makes the bits and
// says where on its edge each vertex lies.
// 1. inside_rows(): the bits, with an empty layer all around, for which set_row() moves each row on by one. Bytes are
//    compared 16 or 32 at a time. For whole numbers iso is rounded down, so that no value need be converted.
// 2. Shares, shares_of(): the share of an edge at which the values, linear along it, reach iso; a half where the edge
//    leaves the volume or a value is not finite.
// 3. contour_of(): bits, crossed edges, vertices, and triangles by the table.
// 4. surface_of(): with `trilinear`, triangles by trilinear_cubes.cpp from corner_values() in their place.
// Invariants: closed whatever the values, as the layer around is outside; a vertex is shared by all cubes around its
// edge. AVX2 changes the time, no bit. Slices are worked on apart: the same bytes for any thread count.
// Cost: O(voxels + triangles), memory a bit a voxel and 12 bytes a row on top of the mesh.
#include "lodestone/voxel/isosurface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "lodestone/base/parallel.h"
#include "lodestone/core/validate.h"
#include "lodestone/voxel/cube_surface_detail.h"
#include "lodestone/voxel/inside_rows_detail.h"
#include "lodestone/voxel/isosurface_detail.h"
#include "lodestone/voxel/trilinear_cubes_detail.h"

namespace lodestone::voxel {

using detail::InsideRows;

namespace {

// Above the limit, and finite.
template <class T>
bool is_inside(T value, T limit) {
  return (value > limit) & (value <= std::numeric_limits<T>::max());
}

// Bit k of the result: values[k] is inside. 64 values.
template <class T>
std::uint64_t above(const T* values, T limit) {
  std::uint64_t word = 0;
  for (std::uint32_t k = 0; k < 64; ++k) word |= std::uint64_t{is_inside(values[k], limit)} << k;
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

#if defined(__x86_64__) && defined(__GNUC__)
#define LODESTONE_WIDE_BYTES 1
// Thirty-two bytes at once, 64 values a word; for processors that have it.
__attribute__((target("avx2"))) void words_above(const std::uint8_t* values, std::uint32_t words, std::uint8_t limit,
                                                 std::uint64_t* out) {
  using Bytes = unsigned char __attribute__((vector_size(32)));
  using Signed = char __attribute__((vector_size(32)));
  const Bytes most = Bytes{} + limit;
  for (std::uint32_t w = 0; w < words; ++w) {
    Bytes low, high;
    std::memcpy(&low, values + w * 64, 32);
    std::memcpy(&high, values + w * 64 + 32, 32);
    const auto a = static_cast<std::uint32_t>(__builtin_ia32_pmovmskb256(reinterpret_cast<Signed>(low > most)));
    const auto b = static_cast<std::uint32_t>(__builtin_ia32_pmovmskb256(reinterpret_cast<Signed>(high > most)));
    out[w] = std::uint64_t{b} << 32 | a;
  }
}
#endif

// The bits of whole words of values.
template <class T>
void all_above(const T* values, std::uint32_t words, T limit, std::uint64_t* out) {
#ifdef LODESTONE_WIDE_BYTES
  if constexpr (std::is_same_v<T, std::uint8_t>) {
    static const bool wide = __builtin_cpu_supports("avx2");
    if (wide) return words_above(values, words, limit, out);
  }
#endif
  for (std::uint32_t w = 0; w < words; ++w) out[w] = above(values + w * 64, limit);
}

// The bits of a row of voxels, one place on for the layer before them.
template <class T>
void set_row(const T* values, std::uint32_t count, T limit, std::uint64_t* bits, std::size_t words) {
  std::uint64_t carried = 0;
  const std::uint32_t whole = count / 64;
  std::uint32_t x = whole * 64;
  std::size_t w = 0;
  all_above(values, whole, limit, bits);
  for (; w < whole; ++w) {
    const std::uint64_t word = bits[w];
    bits[w] = word << 1 | carried;
    carried = word >> 63;
  }
  std::uint64_t rest = 0;
  for (std::uint32_t k = 0; x + k < count; ++k) rest |= std::uint64_t{is_inside(values[x + k], limit)} << k;
  bits[w] = rest << 1 | carried;
  if (w + 1 < words) bits[w + 1] = rest >> 63;
}

template <class T>
InsideRows inside_rows(const VolumeView<T>& volume, double iso, const Task& task) {
  const auto& size = volume.grid.size;
  InsideRows rows(size[0], size[1], size[2]);
  // For whole numbers v > iso is v > floor(iso), which needs no conversion. Below the least value all are inside.
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

// Where along the edges of a row the values reach iso; half way to what lies outside of the volume.
template <class T>
struct Shares {
  const T* from = nullptr;  // value of x at [x - 1]; null: all edges lead out of the volume
  const T* to = nullptr;
  std::uint32_t end = 0;  // of x where the edge stays inside; it begins at `begin`
  std::uint32_t begin = 0;
  float iso = 0;

  double operator()(std::uint32_t x) const {
    if (x < begin || x >= end) return 0.5;
    const auto a = static_cast<float>(from[x - 1]), b = static_cast<float>(to[x - 1]);
    const float share = (iso - a) / (b - a);
    return share >= 0 && share <= 1 ? static_cast<double>(share) : 0.5;  // not finite
  }
};

template <class T>
Shares<T> shares_of(const VolumeView<T>& volume, std::size_t axis, std::uint32_t y, std::uint32_t z, double iso) {
  const auto& size = volume.grid.size;
  Shares<T> out;
  const bool inside = y >= 1 && y <= size[1] && z >= 1 && z <= size[2];
  if (!inside || (axis == 1 && y == size[1]) || (axis == 2 && z == size[2])) return out;
  out.from = volume.values.data() + volume.index(0, y - 1, z - 1);
  const std::size_t step = axis == 0 ? 1 : axis == 1 ? size[0] : std::size_t{size[0]} * size[1];
  out.to = out.from + step;
  out.begin = 1;
  out.end = axis == 0 ? size[0] : size[0] + 1;
  out.iso = static_cast<float>(iso);
  return out;
}

template <class T>
Result<detail::Contour> contour_of(const VolumeView<T>& volume, double iso, const Task& task) {
  const auto& size = volume.grid.size;
  if (!std::isfinite(iso)) return fail(ErrorCode::bad_argument, "the iso value is not a finite number");
  if (volume.values.size() != volume.grid.count() || volume.grid.count() == 0 ||
      *std::max_element(size.begin(), size.end()) > 65'535) {
    return fail(ErrorCode::bad_argument, fmt::format("{} values are no volume of {} x {} x {} voxels",
                                                     volume.values.size(), size[0], size[1], size[2]));
  }
  LODESTONE_TRY(validate(volume));
  InsideRows rows = inside_rows(volume, iso, task);
  Result<detail::CubeSurface> surface = detail::find_surface(rows, task);
  LODESTONE_TRY(surface);
  if (surface->vertices == 0) {
    return fail(ErrorCode::empty, fmt::format("no voxel is above {}", iso), {}, "choose another iso value");
  }
  Mesh mesh;
  detail::place_vertices(
      volume.grid, rows, *surface, mesh, task,
      [&](std::size_t axis, std::uint32_t y, std::uint32_t z) { return shares_of(volume, axis, y, z, iso); });
  detail::make_triangles(rows, *surface, mesh, task);
  if (task.cancelled()) return cancelled_error("contouring");
  return detail::Contour{std::move(rows), std::move(*surface), std::move(mesh)};
}

// Less the iso value; far below it outside of the volume, and where it is no number.
template <class T>
detail::CornerValues corner_values(const VolumeView<T>& volume, double iso, std::uint32_t x, std::uint32_t y,
                                   std::uint32_t z) {
  constexpr double kFar = -1e100;
  const auto& size = volume.grid.size;
  detail::CornerValues values{};
  for (std::uint32_t k = 0; k < 8; ++k) {
    const std::uint32_t px = x + (k & 1), py = y + (k >> 1 & 1), pz = z + (k >> 2 & 1);
    const bool there = px >= 1 && py >= 1 && pz >= 1 && px <= size[0] && py <= size[1] && pz <= size[2];
    const double value = there ? static_cast<double>(volume.at(px - 1, py - 1, pz - 1)) - iso : kFar;
    values[k] = std::isfinite(value) ? value : kFar;
  }
  return values;
}

template <class T>
Result<Mesh> surface_of(const VolumeView<T>& volume, const IsosurfaceOptions& options, const Task& task) {
  Result<detail::Contour> made = contour_of(volume, options.iso, task);
  LODESTONE_TRY(made);
  if (options.trilinear) {
    made->mesh.triangles.clear();
    // As inside_rows() takes it: what is above there must be above here.
    const double iso = std::is_floating_point_v<T> ? static_cast<double>(static_cast<T>(options.iso)) : options.iso;
    const auto values_at = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
      return corner_values(volume, iso, x, y, z);
    };
    detail::make_trilinear_triangles(made->rows, made->surface, values_at, made->mesh, task);
    if (task.cancelled()) return cancelled_error("contouring");
  }
  return std::move(made->mesh);
}

}  // namespace

Result<detail::Contour> detail::contour(const VolumeView<std::uint8_t>& volume, double iso, const Task& task) {
  return contour_of(volume, iso, task);
}

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
