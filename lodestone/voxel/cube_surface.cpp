// Method   crossed edges counted by rows, so that each vertex has its number without a table: the row's first plus the
//          crossed edges before it (population counts of masks). Cut cubes are found once, 64 at a time, and listed
// Source   W. Lorensen and H. Cline, Marching Cubes, SIGGRAPH 1987; rows apart as in W. Schroeder, R. Maynard and B.
//          Geveci, Flying Edges, LDAV 2015
// Cost     O(voxels / 64 + vertices + triangles)
#include "lodestone/voxel/cube_surface_detail.h"

#include <bit>

#include "lodestone/base/cpu.h"
#include "lodestone/voxel/cube_cases_detail.h"
#include "lodestone/voxel/row_numbers_detail.h"

namespace lodestone::voxel::detail {

namespace {

struct RowCounts {
  std::uint32_t vertices[3] = {};  // along x, y, z
  std::uint32_t triangles = 0;
};

// The corners of the cube at bit `bit` of word w that are inside, two at a time.
std::uint32_t corners_at(const FourRows& four, std::size_t w, unsigned bit, bool last_word) {
  std::uint32_t corners = 0;
  for (unsigned k = 0; k < 4; ++k) {
    std::uint64_t pair = four.at[k][w] >> bit;
    if (bit == 63 && !last_word) pair |= four.at[k][w + 1] << 1;
    corners |= static_cast<std::uint32_t>(pair & 3) << (2 * k);
  }
  return corners;
}

// Lists the cut cubes of a row and counts the crossed edges that begin in its first row of voxels. Where no cube of a
// word is cut, no edge of it is crossed.
LODESTONE_CLONED void find_in_row(const InsideRows& rows, std::uint32_t y, std::uint32_t z, const CubeCase* cases,
                                  RowCounts& counts, std::vector<std::uint32_t>& cubes) {
  const FourRows four(rows, y, z);
  const auto& at = four.at;
  std::uint64_t any = at[0][0] | at[1][0] | at[2][0] | at[3][0];
  std::uint64_t all = at[0][0] & at[1][0] & at[2][0] & at[3][0];
  for (std::size_t w = 0; w < rows.row_words; ++w) {
    const bool last_word = w + 1 == rows.row_words;
    const std::uint64_t next_any = last_word ? 0 : at[0][w + 1] | at[1][w + 1] | at[2][w + 1] | at[3][w + 1];
    const std::uint64_t next_all = last_word ? 0 : at[0][w + 1] & at[1][w + 1] & at[2][w + 1] & at[3][w + 1];
    const std::uint64_t cut = (any | any >> 1 | next_any << 63) & ~(all & (all >> 1 | next_all << 63));
    any = next_any;
    all = next_all;
    if (cut == 0) continue;
    counts.vertices[0] += count_of(at[0][w] ^ rows.next_along_x(at[0], w));
    counts.vertices[1] += count_of(at[0][w] ^ at[1][w]);
    counts.vertices[2] += count_of(at[0][w] ^ at[2][w]);
    std::size_t n = cubes.size();
    cubes.resize(n + count_of(cut));
    for (std::uint64_t left = cut; left != 0; left &= left - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(left));
      const std::uint32_t corners = corners_at(four, w, bit, last_word);
      counts.triangles += cases[corners].triangles;
      cubes[n++] = (static_cast<std::uint32_t>(w * 64) + bit) << 8 | corners;
    }
  }
}

LODESTONE_CLONED Triangle* triangles_of_row(const InsideRows& rows, const CubeSurface& surface, std::uint32_t y,
                                            std::uint32_t z, const std::uint32_t* cubes, std::size_t count,
                                            const CubeCase* cases, Triangle* out) {
  RowNumbers numbers(rows, surface, y, z);
  std::uint32_t vertex[12];
  for (std::size_t i = 0; i < count; ++i) {
    numbers.of_cube(cubes[i] >> 8, vertex);
    const CubeCase& one = cases[cubes[i] & 255];
    for (std::size_t t = 0; t < one.triangles; ++t) {
      *out++ = {vertex[one.edges[t][0]], vertex[one.edges[t][1]], vertex[one.edges[t][2]]};
    }
  }
  return out;
}

}  // namespace

Result<CubeSurface> find_surface(const InsideRows& rows, const Task& task) {
  CubeSurface out;
  const CubeCase* cases = cube_cases().data();
  for (auto& first : out.first_vertex) first.assign(rows.rows() + 1, 0);
  out.cubes.resize(rows.depth);
  out.row_cubes.assign(rows.rows(), 0);
  out.first_triangle.assign(rows.depth + 1, 0);
  // The last rows and slices belong to the layer around, where nothing is crossed.
  parallel_for(rows.depth - 1, 1, task, [&](std::size_t slice, std::size_t, std::size_t) {
    const auto z = static_cast<std::uint32_t>(slice);
    std::vector<std::uint32_t>& cubes = out.cubes[z];
    for (std::uint32_t y = 0; y + 1 < rows.height; ++y) {
      const std::size_t row = rows.row(y, z), before = cubes.size();
      RowCounts counts;
      find_in_row(rows, y, z, cases, counts, cubes);
      for (std::size_t axis = 0; axis < 3; ++axis) out.first_vertex[axis][row] = counts.vertices[axis];
      out.row_cubes[row] = static_cast<std::uint32_t>(cubes.size() - before);
      out.first_triangle[z] += counts.triangles;
    }
  });
  if (task.cancelled()) return cancelled_error("contouring");
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    for (auto& first : out.first_vertex) {
      const std::uint32_t count = first[row];
      first[row] = static_cast<std::uint32_t>(out.vertices);
      out.vertices += count;
    }
  }
  if (out.vertices > kNone - 1) {
    return fail(ErrorCode::unsupported, "the surface has more vertices than a mesh can name", {},
                "lower the resolution");
  }
  std::uint64_t triangles = 0;
  for (std::uint64_t& first : out.first_triangle) {
    const std::uint64_t count = first;
    first = triangles;
    triangles += count;
  }
  return out;
}

void make_triangles(const InsideRows& rows, const CubeSurface& surface, Mesh& mesh, const Task& task) {
  const CubeCase* cases = cube_cases().data();
  resize_large(mesh.triangles, static_cast<std::size_t>(surface.first_triangle.back()));
  parallel_for(rows.depth - 1, 1, task, [&](std::size_t slice, std::size_t, std::size_t) {
    const auto z = static_cast<std::uint32_t>(slice);
    Triangle* out = mesh.triangles.data() + surface.first_triangle[z];
    const std::uint32_t* cubes = surface.cubes[z].data();
    for (std::uint32_t y = 0; y + 1 < rows.height; ++y) {
      const std::uint32_t count = surface.row_cubes[rows.row(y, z)];
      if (count == 0) continue;
      out = triangles_of_row(rows, surface, y, z, cubes, count, cases, out);
      cubes += count;
    }
  });
}

}  // namespace lodestone::voxel::detail
