// The surface of a solid of voxels that keeps the creases and corners of the surface that the solid was made from.
//
// Problem: Marching Cubes has its vertices on edges of the lattice, which chamfers every crease. Method: the dual
// surface, with a vertex inside each cut cube, which can be put on a crease (G. Nielson, Dual Marching Cubes, 2004
// [nielson-2004]). Dual contouring finds creases by the normals at the crossings (T. Ju et al., 2002 [ju-2002]); here
// they are taken from the source itself (creases.cpp). Figures: docs/papers/voxel.md, "Sharp edges".
// 1. list_rings(): the rings of crossed edges of each cut cube, and the four rings around each crossed edge.
// 2. place_vertices(): a ring's vertex is the middle of its crossings, moved to the closest point of the source but not
//    out of its cube; where a crease runs through the cube, the ring nearest to it gets the crease's point.
// 3. fill_gaps(): a point of a crease in a cube that is not cut takes the nearest vertex beside it.
// 4. separate_coincident_vertices(): of several vertices at one place all but the first go back to their middles.
// 5. Quads: two triangles over the four rings around each crossed edge; near creases along the diagonal that lies
//    nearer to the source, elsewhere along the shorter. Two rings that meet twice in one face share two sides, and one
//    edge would get four triangles: find_shared_sides() finds these sides, add_fan() gives each a vertex of its own.
// Invariants: closed, with two triangles at every edge. Slices of cubes are worked on apart and joined in order, so the
// bytes are the same for any thread count. Cost: O(voxels + triangles log source).
#include "lodestone/voxel/sharp_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/spatial/closest_batch.h"
#include "lodestone/voxel/coincident_vertices_detail.h"
#include "lodestone/voxel/creases_detail.h"
#include "lodestone/voxel/cube_cases_detail.h"
#include "lodestone/voxel/isosurface_detail.h"
#include "lodestone/voxel/row_numbers_detail.h"

namespace lodestone::voxel {

namespace {

// The rings of a slice of cubes, in order.
struct Slice {
  std::vector<std::uint8_t> length;     // crossed edges of each ring
  std::vector<std::uint32_t> crossing;  // numbers of all, ring after ring
  std::vector<std::uint64_t> cube;      // of each ring
  std::vector<Vec3d> middle;            // of each ring's crossings
  std::vector<Vec3d> vertex;            // of each ring
  std::vector<std::uint8_t> creased;    // 1: vertex on a crease, 2: on a corner
};

// What all steps work on.
struct Dual {
  const detail::Contour& contour;
  const VoxelGrid& grid;
  const spatial::Bvh& source;
  std::vector<Slice> slices;
  std::vector<std::uint32_t> first_ring;  // of each slice
  std::vector<std::uint32_t> ring_at;     // four rings around each crossing
  std::vector<std::uint8_t> twice;        // rings with two lines in one face of their cube
};

Vec3d crossing_point(const Dual& dual, std::uint32_t crossing) { return dual.contour.mesh.position(crossing); }

// The faces of a cube that an edge lies in, as bits.
unsigned faces_of(std::uint8_t edge) {
  const unsigned axis = edge / 4U, corner = detail::kEdgeCorner[edge];
  unsigned faces = 0;
  for (unsigned k = 0; k < 3; ++k) {
    if (k != axis) faces |= 1U << (2 * k + (corner >> k & 1));
  }
  return faces;
}

// Whether a ring goes through one face twice.
bool meets_face_twice(std::span<const std::uint8_t> ring) {
  unsigned once = 0, twice = 0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const unsigned face = faces_of(ring[k]) & faces_of(ring[(k + 1) % ring.size()]);
    twice |= once & face;
    once |= face;
  }
  return twice != 0;
}

void list_rings(Dual& dual, const Task& task) {
  const auto& loops = detail::cube_loops();
  const detail::InsideRows& rows = dual.contour.rows;
  dual.slices.resize(rows.depth - 1);
  parallel_for(dual.slices.size(), 1, task, [&](std::size_t z, std::size_t, std::size_t) {
    Slice& slice = dual.slices[z];
    detail::for_each_cube(rows, dual.contour.surface, static_cast<std::uint32_t>(z),
                          [&](std::uint32_t x, std::uint32_t y, std::uint32_t corners, const std::uint32_t* vertex) {
                            const detail::CubeLoops& of = loops[corners];
                            std::size_t at = 0;
                            for (std::size_t l = 0; l < of.count; ++l) {
                              slice.length.push_back(of.length[l]);
                              slice.cube.push_back((z * rows.height + y) * std::uint64_t{rows.width} + x);
                              for (std::size_t k = 0; k < of.length[l]; ++k) {
                                slice.crossing.push_back(vertex[of.edges[at++]]);
                              }
                            }
                          });
  });
  std::uint32_t count = 0;
  for (const Slice& slice : dual.slices) {
    dual.first_ring.push_back(count);
    count += static_cast<std::uint32_t>(slice.length.size());
  }
  dual.ring_at.assign(4 * static_cast<std::size_t>(dual.contour.surface.vertices), kNone);
  dual.twice.assign(count, 0);
  parallel_for(dual.slices.size(), 1, task, [&](std::size_t z, std::size_t, std::size_t) {
    std::uint32_t ring = dual.first_ring[z];
    detail::for_each_cube(rows, dual.contour.surface, static_cast<std::uint32_t>(z),
                          [&](std::uint32_t, std::uint32_t, std::uint32_t corners, const std::uint32_t* vertex) {
                            const detail::CubeLoops& of = loops[corners];
                            std::size_t at = 0;
                            for (std::size_t l = 0; l < of.count; ++l, ++ring) {
                              const auto edges = std::span(of.edges).subspan(at, of.length[l]);
                              at += of.length[l];
                              dual.twice[ring] = meets_face_twice(edges) ? 1 : 0;
                              // An edge's number among the four of its axis says on which side the cube lies.
                              for (const std::uint8_t e : edges) {
                                dual.ring_at[4 * std::size_t{vertex[e]} + (e & 3)] = ring;
                              }
                            }
                          });
  });
}

// How often a vertex goes to the source and back into its cube: it must not jump onto a crease in another cube.
constexpr int kTurns = 3;

Vec3d kept_in_cube(const Dual& dual, Vec3d at, std::uint64_t cube) {
  const std::uint64_t width = dual.contour.rows.width, height = dual.contour.rows.height;
  const Vec3d low =
      dual.grid.point({static_cast<double>(cube % width) - 0.5, static_cast<double>(cube / width % height) - 0.5,
                       static_cast<double>(cube / width / height) - 0.5});
  for (std::size_t k = 0; k < 3; ++k) at[k] = std::clamp(at[k], low[k], low[k] + dual.grid.spacing[k]);
  return at;
}

// Middles of rings, moved to the source, or onto the crease that runs through their cube.
void place_vertices(Dual& dual, const std::vector<detail::CreasePoint>& creases, const Task& task) {
  const Vec3d s = dual.grid.spacing;
  const double most_sq = s.x * s.x + s.y * s.y + s.z * s.z;
  parallel_for(dual.slices.size(), 1, task, [&](std::size_t z, std::size_t, std::size_t) {
    Slice& slice = dual.slices[z];
    const std::size_t count = slice.length.size();
    std::size_t at = 0;
    for (std::size_t r = 0; r < count; ++r) {
      Vec3d sum;
      for (std::size_t k = 0; k < slice.length[r]; ++k) sum += crossing_point(dual, slice.crossing[at++]);
      slice.middle.push_back(sum / static_cast<double>(slice.length[r]));
    }
    slice.vertex = slice.middle;
    std::vector<Vec3d> moved = slice.middle;
    std::vector<spatial::Nearest> nearest(count);
    for (int turn = 0; turn < kTurns; ++turn) {
      spatial::ClosestBatch(dual.source).find(moved, nearest);
      for (std::size_t r = 0; r < count; ++r) {
        if (nearest[r].distance_sq <= most_sq) moved[r] = kept_in_cube(dual, nearest[r].point, slice.cube[r]);
      }
    }
    slice.creased.assign(count, 0);
    for (std::size_t r = 0; r < count;) {
      std::size_t end = r;
      while (end < count && slice.cube[end] == slice.cube[r]) ++end;
      const auto crease =
          std::lower_bound(creases.begin(), creases.end(), slice.cube[r],
                           [](const detail::CreasePoint& c, std::uint64_t cube) { return c.cube < cube; });
      std::size_t taken = end;  // the ring nearest to the crease gets it
      if (crease != creases.end() && crease->cube == slice.cube[r]) {
        double least = most_sq;
        for (std::size_t k = r; k < end; ++k) {
          const Vec3d d = slice.vertex[k] - crease->point;
          if (dot(d, d) >= least) continue;
          least = dot(d, d);
          taken = k;
        }
      }
      for (; r < end; ++r) {
        if (r == taken) {
          slice.vertex[r] = crease->point;
          slice.creased[r] = crease->corner ? 2 : 1;
        } else {
          slice.vertex[r] = moved[r];
        }
      }
    }
  });
}

// Rings of a cube, as numbers within its slice: first and end.
std::pair<std::size_t, std::size_t> rings_of_cube(const Slice& slice, std::uint64_t cube) {
  const auto [low, high] = std::equal_range(slice.cube.begin(), slice.cube.end(), cube);
  return {static_cast<std::size_t>(low - slice.cube.begin()), static_cast<std::size_t>(high - slice.cube.begin())};
}

// Moves the nearest vertex beside a cube that is not cut onto the crease in it. Vertices on a crease stay, but to a
// corner they may go, unless they are on one already.
void take_vertex_beside(Dual& dual, const detail::CreasePoint& crease) {
  const std::uint64_t width = dual.contour.rows.width, height = dual.contour.rows.height;
  const std::uint64_t z = crease.cube / width / height;
  const Vec3d s = dual.grid.spacing;
  double least = s.x * s.x + s.y * s.y + s.z * s.z;
  Slice* slice = nullptr;
  std::size_t ring = 0;
  for (std::uint64_t k = 0; k < 27; ++k) {
    const std::uint64_t dz = k / 9, dy = k / 3 % 3, dx = k % 3;  // one more than the step
    if (z + dz < 1 || z + dz - 1 >= dual.slices.size()) continue;
    const std::uint64_t cube = crease.cube + dz * height * width + dy * width + dx - height * width - width - 1;
    Slice& beside = dual.slices[z + dz - 1];
    const auto [first, end] = rings_of_cube(beside, cube);
    for (std::size_t r = first; r < end; ++r) {
      const Vec3d d = beside.vertex[r] - crease.point;
      if (beside.creased[r] > (crease.corner ? 1 : 0) || dot(d, d) >= least) continue;
      least = dot(d, d);
      slice = &beside;
      ring = r;
    }
  }
  if (slice == nullptr) return;
  slice->vertex[ring] = crease.point;
  slice->creased[ring] = crease.corner ? 2 : 1;
}

// A crease may run through cubes that are not cut, where the solid is thin; without this it would have a gap there.
// Corners first.
void fill_gaps(Dual& dual, const std::vector<detail::CreasePoint>& creases) {
  const std::uint64_t slice = std::uint64_t{dual.contour.rows.width} * dual.contour.rows.height;
  for (const bool corners : {true, false}) {
    for (const detail::CreasePoint& crease : creases) {
      const std::uint64_t z = crease.cube / slice;
      if (crease.corner != corners || z >= dual.slices.size()) continue;
      const auto own = rings_of_cube(dual.slices[z], crease.cube);
      if (own.first == own.second) take_vertex_beside(dual, crease);
    }
  }
}

// Rings around a crossing, counter-clockwise seen from outside.
std::array<std::uint32_t, 4> rings_around(const Dual& dual, std::uint32_t crossing, std::size_t axis, bool outward) {
  const std::uint32_t* r = dual.ring_at.data() + 4 * std::size_t{crossing};
  if (outward == (axis != 1)) return {r[0], r[1], r[3], r[2]};
  return {r[0], r[2], r[3], r[1]};
}

// A side that two rings share twice, by one of the crossings at its ends.
struct SharedEdge {
  std::uint32_t low = 0, high = 0, crossing = 0;
  bool operator<(const SharedEdge& o) const {
    return low != o.low ? low < o.low : high != o.high ? high < o.high : crossing < o.crossing;
  }
};

// Triangles over the crossings of each slice; those whose rings share two sides are left for later.
class Quads {
 public:
  Quads(const Dual& dual, Mesh& mesh) : dual_(dual), mesh_(mesh) {
    creased_.reserve(mesh.positions.size());
    for (const Slice& slice : dual.slices) creased_.insert(creased_.end(), slice.creased.begin(), slice.creased.end());
  }

  void make(const Task& task) {
    find_shared_sides(task);
    const detail::InsideRows& rows = dual_.contour.rows;
    std::vector<std::vector<Triangle>> parts(rows.depth - 1);
    std::vector<std::vector<std::array<std::uint32_t, 5>>> left(rows.depth - 1);
    each_crossing(task, [&](std::size_t z, std::uint32_t crossing, const std::array<std::uint32_t, 4>& rings) {
      if (shares_side(rings)) {
        left[z].push_back({rings[0], rings[1], rings[2], rings[3], crossing});
        return;
      }
      const bool first = takes_first_diagonal(rings);
      const std::array<std::uint32_t, 4> r = first ? rings : std::array{rings[1], rings[2], rings[3], rings[0]};
      parts[z].push_back({r[0], r[1], r[2]});
      parts[z].push_back({r[0], r[2], r[3]});
    });
    for (std::vector<Triangle>& part : parts) {
      mesh_.triangles.insert(mesh_.triangles.end(), part.begin(), part.end());
      free_memory(part);
    }
    for (const auto& slice : left) {
      for (const auto& quad : slice) add_fan(quad);
    }
  }

 private:
  template <class Take>
  void each_crossing(const Task& task, Take&& take) const {
    const detail::InsideRows& rows = dual_.contour.rows;
    parallel_for(rows.depth - 1, 1, task, [&](std::size_t slice, std::size_t, std::size_t) {
      const auto z = static_cast<std::uint32_t>(slice);
      for (std::uint32_t y = 0; y + 1 < rows.height; ++y) {
        const std::size_t row = rows.row(y, z);
        if (dual_.contour.surface.row_cubes[row] == 0) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          std::uint32_t crossing = dual_.contour.surface.first_vertex[axis][row];
          rows.for_each_crossed(axis, y, z, [&](std::uint32_t x) {
            const bool inside = (rows.bits(row)[x / 64] >> (x % 64) & 1) != 0;
            take(slice, crossing, rings_around(dual_, crossing, axis, inside));
            ++crossing;
          });
        }
      }
    });
  }

  // Only rings that go through a face twice can share two sides.
  void find_shared_sides(const Task& task) {
    std::vector<std::vector<SharedEdge>> found(dual_.contour.rows.depth - 1);
    each_crossing(task, [&](std::size_t z, std::uint32_t crossing, const std::array<std::uint32_t, 4>& rings) {
      for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t a = rings[k], b = rings[(k + 1) % 4];
        if (dual_.twice[a] != 0 && dual_.twice[b] != 0) {
          found[z].push_back({std::min(a, b), std::max(a, b), crossing});
        }
      }
    });
    std::vector<SharedEdge> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    std::sort(all.begin(), all.end());
    for (std::size_t i = 0; i < all.size();) {
      std::size_t end = i;
      while (end < all.size() && all[end].low == all[i].low && all[end].high == all[i].high) ++end;
      if (end - i == 4)
        shared_.insert(shared_.end(), all.begin() + static_cast<std::ptrdiff_t>(i),
                       all.begin() + static_cast<std::ptrdiff_t>(end));
      i = end;
    }
    middles_.assign(shared_.size(), kNone);
  }

  bool shares_side(const std::array<std::uint32_t, 4>& rings) const {
    if (shared_.empty()) return false;
    for (std::size_t k = 0; k < 4; ++k) {
      if (side_of(rings[k], rings[(k + 1) % 4], 0) != kNone) return true;
    }
    return false;
  }

  // The first of the four entries of a side, or that of a crossing.
  std::uint32_t side_of(std::uint32_t a, std::uint32_t b, std::uint32_t crossing) const {
    const SharedEdge wanted{std::min(a, b), std::max(a, b), crossing};
    const auto at = std::lower_bound(shared_.begin(), shared_.end(), wanted);
    if (at == shared_.end() || at->low != wanted.low || at->high != wanted.high) return kNone;
    return static_cast<std::uint32_t>(at - shared_.begin());
  }

  // The vertex in the middle of the line between two rings that ends at a crossing; made for the first that asks.
  std::uint32_t middle_of(std::uint32_t a, std::uint32_t b, std::uint32_t crossing) {
    const std::uint32_t mine = side_of(a, b, crossing);
    if (middles_[mine] != kNone) return middles_[mine];
    // The other end of the line is the crossing beside this one in ring a's order that ring b has, too.
    const std::uint32_t first = side_of(a, b, 0);
    const std::uint32_t other = other_end(a, b, crossing, first);
    const Vec3d middle = (crossing_point(dual_, crossing) + crossing_point(dual_, shared_[other].crossing)) / 2;
    const auto vertex = static_cast<std::uint32_t>(mesh_.positions.size());
    mesh_.positions.push_back(to_float(middle - mesh_.offset));
    middles_[mine] = middles_[other] = vertex;
    return vertex;
  }

  std::uint32_t other_end(std::uint32_t a, std::uint32_t b, std::uint32_t crossing, std::uint32_t first) const {
    const std::vector<std::uint32_t> in_a = crossings_of(a), in_b = crossings_of(b);
    for (std::uint32_t i = first; i < first + 4; ++i) {
      const std::uint32_t c = shared_[i].crossing;
      if (c != crossing && beside(in_a, c, crossing) && beside(in_b, c, crossing)) return i;
    }
    return first;
  }

  std::vector<std::uint32_t> crossings_of(std::uint32_t ring) const {
    const auto next = std::upper_bound(dual_.first_ring.begin(), dual_.first_ring.end(), ring);
    const auto z = static_cast<std::size_t>(next - dual_.first_ring.begin()) - 1;
    const Slice& slice = dual_.slices[z];
    std::size_t at = 0;
    const std::uint32_t local = ring - dual_.first_ring[z];
    for (std::uint32_t r = 0; r < local; ++r) at += slice.length[r];
    return {slice.crossing.begin() + static_cast<std::ptrdiff_t>(at),
            slice.crossing.begin() + static_cast<std::ptrdiff_t>(at + slice.length[local])};
  }

  static bool beside(const std::vector<std::uint32_t>& ring, std::uint32_t a, std::uint32_t b) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const std::uint32_t next = ring[(k + 1) % ring.size()];
      if ((ring[k] == a && next == b) || (ring[k] == b && next == a)) return true;
    }
    return false;
  }

  // A fan around the crossing, with a vertex on each side that is there twice.
  void add_fan(const std::array<std::uint32_t, 5>& quad) {
    const std::uint32_t crossing = quad[4];
    std::vector<std::uint32_t> border;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t a = quad[k], b = quad[(k + 1) % 4];
      border.push_back(a);
      if (side_of(a, b, 0) != kNone) border.push_back(middle_of(a, b, crossing));
    }
    const auto centre = static_cast<std::uint32_t>(mesh_.positions.size());
    mesh_.positions.push_back(to_float(crossing_point(dual_, crossing) - mesh_.offset));
    for (std::size_t k = 0; k < border.size(); ++k) {
      mesh_.triangles.push_back({border[k], border[(k + 1) % border.size()], centre});
    }
  }

  // Whether the diagonal from ring 0 to 2 fits the source better than that from 1 to 3. Away from creases the shorter.
  bool takes_first_diagonal(const std::array<std::uint32_t, 4>& r) const {
    const auto at = [&](std::size_t k) { return to_double(mesh_.positions[r[k]]); };
    const bool near_crease = (creased_[r[0]] | creased_[r[1]] | creased_[r[2]] | creased_[r[3]]) != 0;
    if (!near_crease) return length(at(0) - at(2)) <= length(at(1) - at(3));
    const auto off = [&](std::size_t i, std::size_t k) {
      return dual_.source.closest((at(i) + at(k)) / 2 + mesh_.offset).distance_sq;
    };
    const double first = off(0, 2), second = off(1, 3);
    return first != second ? first < second : length(at(0) - at(2)) <= length(at(1) - at(3));
  }

  const Dual& dual_;
  Mesh& mesh_;
  std::vector<std::uint8_t> creased_;
  std::vector<SharedEdge> shared_;      // four entries a side that is there twice, sorted
  std::vector<std::uint32_t> middles_;  // of each entry, once made
};

}  // namespace

Result<SharpSurface> sharp_surface(const VolumeView<std::uint8_t>& volume, const spatial::Bvh& source,
                                   const SharpOptions& options, Task task) {
  const Result<detail::Contour> contour = detail::contour(volume, options.iso, task.part(0.2));
  LODESTONE_TRY(contour);
  Dual dual{*contour, volume.grid, source, {}, {}, {}, {}};
  list_rings(dual, task);
  const std::vector<detail::CreasePoint> creases =
      detail::crease_points(source.surface(), volume.grid, options.crease_cosine);
  place_vertices(dual, creases, task);
  fill_gaps(dual, creases);
  if (task.cancelled()) return cancelled_error("contouring");
  SharpSurface out;
  Mesh& mesh = out.mesh;
  mesh.offset = contour->mesh.offset;
  std::vector<Vec3f> middles;
  for (const Slice& slice : dual.slices) {
    for (const Vec3d& at : slice.vertex) mesh.positions.push_back(to_float(at - mesh.offset));
    for (const Vec3d& at : slice.middle) middles.push_back(to_float(at - mesh.offset));
    out.features += static_cast<std::size_t>(
        std::count_if(slice.creased.begin(), slice.creased.end(), [](std::uint8_t c) { return c > 0; }));
  }
  detail::separate_coincident_vertices(middles, mesh.positions);
  Quads(dual, mesh).make(task);
  if (task.cancelled()) return cancelled_error("contouring");
  return out;
}

}  // namespace lodestone::voxel
