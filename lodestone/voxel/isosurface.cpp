// Method   a bit a voxel; vertices counted by rows, so that each has its number without a table: the row's first plus
//          the crossed edges before it (population counts of masks); then the triangles of all cubes that are cut
// Source   W. Lorensen and H. Cline, Marching Cubes, SIGGRAPH 1987; rows apart as in W. Schroeder, R. Maynard and B.
//          Geveci, Flying Edges, LDAV 2015
// Cost     O(voxels / 64 + vertices + triangles) after the bits
#include "lodestone/voxel/isosurface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "lodestone/base/parallel.h"
#include "lodestone/voxel/cube_cases_detail.h"
#include "lodestone/voxel/inside_rows_detail.h"

namespace lodestone::voxel {

using detail::CrossedEdges;
using detail::CubeCase;
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
void set_row(const T* values, std::uint32_t count, T limit, std::span<std::uint64_t> bits) {
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
  if (w + 1 < bits.size()) bits[w + 1] = rest >> 63;
}

template <class T>
InsideRows inside_rows(const VolumeView<T>& volume, double iso, const Task& task) {
  const auto& size = volume.grid.size;
  InsideRows rows(size[0], size[1], size[2]);
  // For whole numbers v > iso is v > floor(iso), which needs no conversion. Where that is below the least, all are inside.
  constexpr bool kWhole = !std::is_floating_point_v<T>;
  if (kWhole && iso >= static_cast<double>(std::numeric_limits<T>::max())) return rows;
  const bool all = kWhole && iso < static_cast<double>(std::numeric_limits<T>::lowest());
  const T limit = all ? T{0} : static_cast<T>(kWhole ? std::floor(iso) : iso);
  const std::vector<T> ones(all ? size[0] : 0, T{1});
  parallel_for(size[2], 1, task, [&](std::size_t z, std::size_t, std::size_t) {
    for (std::uint32_t y = 0; y < size[1]; ++y) {
      const T* values = all ? ones.data() : volume.values.data() + volume.index(0, y, static_cast<std::uint32_t>(z));
      set_row(values, size[0], limit, rows.bits(rows.row(y + 1, static_cast<std::uint32_t>(z) + 1)));
    }
  });
  return rows;
}

// Numbers of the first vertex on the edges of each row, along x, y and z.
struct VertexNumbers {
  std::array<std::vector<std::uint32_t>, 3> first;
  std::uint64_t count = 0;
};

// The edges of a row along one axis that are crossed; false where the volume ends.
bool crossed(const InsideRows& rows, std::uint32_t y, std::uint32_t z, std::size_t axis, CrossedEdges& edges) {
  const std::span<const std::uint64_t> here = rows.bits(rows.row(y, z));
  if (axis == 0) {
    edges.along_x(here);
    return true;
  }
  if (axis == 1 ? y + 1 == rows.height : z + 1 == rows.depth) return false;
  edges.between(here, rows.bits(axis == 1 ? rows.row(y + 1, z) : rows.row(y, z + 1)));
  return true;
}

VertexNumbers number_vertices(const InsideRows& rows, const Task& task) {
  VertexNumbers numbers;
  for (auto& first : numbers.first) first.assign(rows.rows(), 0);
  parallel_for(rows.depth, 1, task, [&](std::size_t z, std::size_t, std::size_t) {
    CrossedEdges edges(rows.row_words);
    for (std::uint32_t y = 0; y < rows.height; ++y) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!crossed(rows, y, static_cast<std::uint32_t>(z), axis, edges)) continue;
        numbers.first[axis][rows.row(y, static_cast<std::uint32_t>(z))] = edges.count();
      }
    }
  });
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    for (auto& first : numbers.first) {
      const std::uint32_t count = first[row];
      first[row] = static_cast<std::uint32_t>(numbers.count);
      numbers.count += count;
    }
  }
  return numbers;
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
void place_vertices(const VolumeView<T>& volume, const InsideRows& rows, const VertexNumbers& numbers, double iso,
                    Mesh& mesh, const Task& task) {
  const auto& size = volume.grid.size;
  mesh.offset = volume.grid.point({size[0] / 2.0, size[1] / 2.0, size[2] / 2.0});
  mesh.positions.resize(static_cast<std::size_t>(numbers.count));
  parallel_for(rows.depth, 1, task, [&](std::size_t slice, std::size_t, std::size_t) {
    const auto z = static_cast<std::uint32_t>(slice);
    CrossedEdges edges(rows.row_words);
    for (std::uint32_t y = 0; y < rows.height; ++y) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!crossed(rows, y, z, axis, edges)) continue;
        std::uint32_t vertex = numbers.first[axis][rows.row(y, z)];
        edges.for_each([&](std::uint32_t x) {
          Vec3d at{x - 0.5, y - 0.5, z - 0.5};  // the layer around takes one voxel
          at[axis] += share_between(volume, {x, y, z}, axis, iso);
          mesh.positions[vertex++] = to_float(volume.grid.point(at) - mesh.offset);
        });
      }
    }
  });
}

// The four rows of a row of cubes, and how their crossed edges are numbered.
class CubeRow {
 public:
  CubeRow(const InsideRows& rows, const VertexNumbers& numbers)
      : rows_(rows), numbers_(numbers), edges_(8, CrossedEdges(rows.row_words)) {}

  void move_to(std::uint32_t y, std::uint32_t z) {
    const std::array<std::size_t, 4> row{rows_.row(y, z), rows_.row(y + 1, z), rows_.row(y, z + 1),
                                         rows_.row(y + 1, z + 1)};
    for (std::size_t k = 0; k < 4; ++k) bits_[k] = rows_.bits(row[k]);
    row_ = row;
  }

  /// Calls take(x, case) for each cube that is cut.
  template <class Take>
  void for_each(Take&& take) const {
    for (std::size_t w = 0; w < rows_.row_words; ++w) {
      std::array<std::uint64_t, 4> here{}, next{};
      std::uint64_t any = 0, every = ~std::uint64_t{0};
      for (std::size_t k = 0; k < 4; ++k) {
        here[k] = bits_[k][w];
        next[k] = detail::next_voxels(bits_[k], w);
        any |= here[k] | next[k];
        every &= here[k] & next[k];
      }
      for (std::uint64_t left = any & ~every; left != 0; left &= left - 1) {
        const auto bit = static_cast<unsigned>(std::countr_zero(left));
        unsigned inside = 0;
        for (std::size_t k = 0; k < 4; ++k) {
          inside |= static_cast<unsigned>(here[k] >> bit & 1) << (2 * k);
          inside |= static_cast<unsigned>(next[k] >> bit & 1) << (2 * k + 1);
        }
        take(static_cast<std::uint32_t>(w * 64) + bit, inside);
      }
    }
  }

  /// To be called before vertex(), once a row.
  void count_edges() {
    for (std::size_t k = 0; k < 4; ++k) edges_[k].along_x(bits_[k]);
    edges_[4].between(bits_[0], bits_[1]);  // along y, at z and z + 1
    edges_[5].between(bits_[2], bits_[3]);
    edges_[6].between(bits_[0], bits_[2]);  // along z, at y and y + 1
    edges_[7].between(bits_[1], bits_[3]);
  }

  /// The vertex on an edge of the cube at x.
  std::uint32_t vertex(std::uint32_t x, std::uint8_t edge) const {
    const unsigned corner = detail::kEdgeCorner[edge], axis = edge / 4U;
    const std::size_t row = corner >> 1;  // of the four: y + 1 is bit 0, z + 1 bit 1
    const std::size_t list = axis == 0 ? row : axis == 1 ? 4 + (row >> 1) : 6 + row;
    return numbers_.first[axis][row_[row]] + edges_[list].rank(x + (corner & 1));
  }

 private:
  const InsideRows& rows_;
  const VertexNumbers& numbers_;
  std::array<std::size_t, 4> row_{};
  std::array<std::span<const std::uint64_t>, 4> bits_;
  std::vector<CrossedEdges> edges_;
};

void make_triangles(const InsideRows& rows, const VertexNumbers& numbers, Mesh& mesh, const Task& task) {
  const std::array<CubeCase, 256>& cases = detail::cube_cases();
  std::vector<std::uint64_t> first(rows.depth, 0);  // triangles of each slice of cubes, then those before it
  parallel_for(rows.depth - 1, 1, task, [&](std::size_t z, std::size_t, std::size_t) {
    CubeRow row(rows, numbers);
    for (std::uint32_t y = 0; y + 1 < rows.height; ++y) {
      row.move_to(y, static_cast<std::uint32_t>(z));
      row.for_each([&](std::uint32_t, unsigned inside) { first[z] += cases[inside].triangles; });
    }
  });
  std::uint64_t count = 0;
  for (std::uint64_t& f : first) {
    const std::uint64_t n = f;
    f = count;
    count += n;
  }
  mesh.triangles.resize(static_cast<std::size_t>(count));
  parallel_for(rows.depth - 1, 1, task, [&](std::size_t z, std::size_t, std::size_t) {
    CubeRow row(rows, numbers);
    Triangle* out = mesh.triangles.data() + first[z];
    for (std::uint32_t y = 0; y + 1 < rows.height; ++y) {
      row.move_to(y, static_cast<std::uint32_t>(z));
      bool counted = false;
      row.for_each([&](std::uint32_t x, unsigned inside) {
        if (!counted) row.count_edges();
        counted = true;
        const CubeCase& one = cases[inside];
        for (std::size_t t = 0; t < one.triangles; ++t) {
          for (std::size_t k = 0; k < 3; ++k) (*out)[k] = row.vertex(x, one.edges[t][k]);
          ++out;
        }
      });
    }
  });
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
  const VertexNumbers numbers = number_vertices(rows, task);
  if (task.cancelled()) return cancelled_error("contouring");
  if (numbers.count == 0) {
    return fail(ErrorCode::empty, fmt::format("no voxel is above {}", options.iso), {}, "choose another iso value");
  }
  if (numbers.count > kNone - 1) {
    return fail(ErrorCode::unsupported, "the surface has more vertices than a mesh can name", {},
                "lower the resolution");
  }
  Mesh mesh;
  place_vertices(volume, rows, numbers, options.iso, mesh, task);
  make_triangles(rows, numbers, mesh, task);
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
