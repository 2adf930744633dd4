// Method   crossed edges counted by rows, so that each vertex has its number without a table: the row's first plus the
//          crossed edges before it (population counts of masks). Cut cubes are found once, 64 at a time, and listed
// Source   W. Lorensen and H. Cline, Marching Cubes, SIGGRAPH 1987; rows apart as in W. Schroeder, R. Maynard and B.
//          Geveci, Flying Edges, LDAV 2015
// Cost     O(voxels / 64 + vertices + triangles)
#include "lodestone/voxel/cube_surface_detail.h"

#include <bit>

#include "lodestone/base/cpu.h"
#include "lodestone/voxel/cube_cases_detail.h"

namespace lodestone::voxel::detail {

namespace {

// The four rows of a row of cubes: (y, z), (y + 1, z), (y, z + 1), (y + 1, z + 1).
struct FourRows {
  const std::uint64_t* at[4];

  FourRows(const InsideRows& rows, std::uint32_t y, std::uint32_t z)
      : at{rows.bits(rows.row(y, z)), rows.bits(rows.row(y + 1, z)), rows.bits(rows.row(y, z + 1)),
           rows.bits(rows.row(y + 1, z + 1))} {}
};

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

std::uint32_t count_of(std::uint64_t bits) { return static_cast<std::uint32_t>(std::popcount(bits)); }

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

// Numbers of the vertices on the eight rows of edges beside a row of cubes, found from left to right.
class RowNumbers {
 public:
  RowNumbers(const InsideRows& rows, const CubeSurface& surface, std::uint32_t y, std::uint32_t z)
      : rows_(rows), four_(rows, y, z) {
    const std::size_t at[4] = {rows.row(y, z), rows.row(y + 1, z), rows.row(y, z + 1), rows.row(y + 1, z + 1)};
    for (std::size_t k = 0; k < 4; ++k) before_[k] = surface.first_vertex[0][at[k]];
    before_[4] = surface.first_vertex[1][at[0]];  // along y, at z and z + 1
    before_[5] = surface.first_vertex[1][at[2]];
    before_[6] = surface.first_vertex[2][at[0]];  // along z, at y and y + 1
    before_[7] = surface.first_vertex[2][at[1]];
  }

  // The twelve vertices of the cube at x, of which those on crossed edges mean something. Cubes must come in order; no
  // edge is crossed in words without cubes.
  void of_cube(std::uint32_t x, std::uint32_t (&vertex)[12]) {
    if (x / 64 != word_) enter(x / 64);
    const unsigned bit = x % 64;
    const std::uint64_t below = (std::uint64_t{1} << bit) - 1;
    std::uint32_t rank[8];
    for (std::size_t k = 0; k < 8; ++k) {
      rank[k] = before_[k] + count_of(mask_[k] & below);
    }
    for (std::size_t k = 0; k < 4; ++k) vertex[k] = rank[k];
    // Corner 0, 1 (x + 1), 4 (z + 1), 5 for the edges along y; 0, 1, 2 (y + 1), 3 for those along z.
    for (std::size_t k = 0; k < 2; ++k) {
      vertex[4 + 2 * k] = rank[4 + k];
      vertex[5 + 2 * k] = rank[4 + k] + static_cast<std::uint32_t>(mask_[4 + k] >> bit & 1);
      vertex[8 + 2 * k] = rank[6 + k];
      vertex[9 + 2 * k] = rank[6 + k] + static_cast<std::uint32_t>(mask_[6 + k] >> bit & 1);
    }
  }

 private:
  void enter(std::uint32_t word) {
    for (std::size_t k = 0; k < 8; ++k) before_[k] += count_of(mask_[k]);
    word_ = word;
    const auto& at = four_.at;
    for (std::size_t k = 0; k < 4; ++k) mask_[k] = at[k][word] ^ rows_.next_along_x(at[k], word);
    mask_[4] = at[0][word] ^ at[1][word];
    mask_[5] = at[2][word] ^ at[3][word];
    mask_[6] = at[0][word] ^ at[2][word];
    mask_[7] = at[1][word] ^ at[3][word];
  }

  const InsideRows& rows_;
  FourRows four_;
  std::uint32_t word_ = kNone;
  std::uint64_t mask_[8] = {};    // crossed edges of this word
  std::uint32_t before_[8] = {};  // vertices before it
};

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
