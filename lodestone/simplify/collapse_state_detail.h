// The working mesh of an edge-collapse run: flat arrays, compacted after every pass.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/collapse_log.h"
#include "lodestone/core/mesh.h"
#include "lodestone/simplify/edge_collapse.h"

namespace lodestone::simplify::detail {

/// What a vertex may do. A *feature edge* is a border, a seam, an edge between two face groups or a non-manifold edge.
/// The class never changes: features collapse only along themselves.
enum class VertexClass : std::uint8_t {
  interior,  ///< on no feature edge, one closed fan: may move and vanish
  feature,   ///< on exactly two feature edges that every fan joins: may move and vanish along them
  fixed,     ///< where features meet or end, bow-ties, locked by request: stays; others may collapse into it
};

/// Why a vertex is fixed, for LockCounts.
enum class LockCause : std::uint8_t { none, border, seam_corner, non_manifold, by_request };

/// Cross product of a triangle's sides and the inverse of its length (0 for a triangle without area).
struct alignas(16) TriangleNormal {
  Vec3f n;
  float inverse_length = 0;
};
TriangleNormal triangle_normal(Vec3f a, Vec3f b, Vec3f c);

/// Sum over a vertex's triangles about the vertex itself, where all linear terms vanish (memoryless, Lindstrom & Turk
/// 1998). Each triangle counts n n^T / |n| with n its cross product: squared distance times twice the area. 48 bytes.
struct alignas(16) Quadric {
  float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  Vec3f volume;    ///< sum of n: moving the vertex by d changes the volume by (volume . d) / 6
  Vec3f position;  ///< the vertex
};

/// One accepted collapse, in the working frame.
struct Step {
  std::uint32_t kept, removed;  ///< vertices of the input mesh
  Vec3f position;               ///< of `kept`, working frame; unused when !moved
  float cost;
  float error;  ///< largest distance of the new position to the planes around, working frame
  std::uint32_t first_wedge, wedge_count;
  std::uint32_t faces;
  bool moved;
};

struct State {
  // The frame: working position = metric * (position - center) / scale, scale a power of two near the mean edge length.
  Vec3d center;
  Mat4d metric, metric_inverse;
  double scale = 1;

  // The mesh as it is between passes; vertices keep a space-filling order so that neighbours are near in memory.
  std::vector<Vec3f> positions;
  std::vector<VertexClass> classes;
  std::vector<std::uint32_t> original;  ///< vertex of the input mesh
  std::vector<Triangle> triangles;      ///< vertices
  std::vector<Triangle> wedges;         ///< wedges of the input mesh; empty when the run need not know them
  std::vector<std::uint32_t> groups;    ///< face group of each triangle; empty when there is one
  std::vector<std::uint32_t> dropped;   ///< input triangles that take no part

  // About the input's wedges; empty as above.
  std::vector<std::uint32_t> chart;  ///< class of each wedge with normals and tangents left out: a change is a seam
  std::vector<Vec3f> wedge_normals;  ///< of the input; empty when it has none

  std::vector<LockCause> causes;  ///< one a vertex of the input

  // Rebuilt every pass.
  std::vector<std::uint32_t> star_first, star;  ///< triangles around each vertex
  std::vector<TriangleNormal> normals;          ///< of the triangles at the pass's start, and a last one of zeros
  std::vector<Quadric> quadrics;
  std::vector<std::uint8_t> inner;    ///< the vertex's whole ring lies in its range (see vertices_per_range)
  std::vector<std::uint32_t> remap;   ///< vertex -> the one that it has merged into in this pass
  std::vector<std::uint8_t> done;     ///< endpoint of a collapse of this pass
  std::vector<std::uint8_t> touched;  ///< its star changed in this pass: quadric and costs are stale
  std::vector<std::uint32_t> mark;    ///< scratch of the link condition

  std::span<const std::uint32_t> star_of(std::uint32_t v) const {
    return std::span(star).subspan(star_first[v], star_first[v + 1] - star_first[v]);
  }
};

/// Vertices with more triangles than this sit out a pass (others may still collapse into their neighbours), which
/// bounds time.
inline constexpr std::size_t kMaxValence = 512;

/// Builds the working mesh: frame, order, classes. Errors: cancelled.
Result<State> make_state(const Mesh& mesh, const EdgeCollapseOptions& options, const Task& task);

/// Fills classes and causes from the working mesh.
void classify_vertices(State& state, const EdgeCollapseOptions& options, const Task& task);

/// Builds star_first and star from triangles. O(triangles).
void build_stars(State& state, const Task& task);

/// True if the edge is a feature: not exactly two triangles, or these differ in group or in a chart at one end.
/// `triangles` are those with both a and b.
bool is_feature_edge(const State& state, std::uint32_t a, std::uint32_t b, std::span<const std::uint32_t> triangles);

/// Vertices of equal length ranges are swept apart: an edge whose two rings lie in one range meets no other range's
/// work. The cut depends on the vertex count alone.
std::size_t vertices_per_range(std::size_t vertices);

/// Quadrics of all vertices and `inner` at the start of a pass. Feature vertices get the lines of their feature edges,
/// too.
void compute_quadrics(State& state, const Task& task);

/// Quadric of an interior vertex from its star as it is now, amid a pass.
Quadric current_quadric(const State& state, std::uint32_t v);

/// An edge that may collapse, and how. 24 bytes.
struct Candidate {
  std::uint32_t kept, removed;
  Vec3f position;
  float cost;  ///< see Placement
};

/// All candidates whose lower vertex lies in [begin, end), from quadrics up to date. Edges that can never collapse are
/// left out.
void collect_candidates(const State& state, std::uint32_t begin, std::uint32_t end, std::vector<Candidate>& out);

/// Cost bin of a candidate: the exponent and three bits of the mantissa; bins rise with costs.
std::size_t bin_of(float cost);
inline constexpr std::size_t kBins = 2048;

/// Tries collapses one after the other; one object a thread of work.
class Sweeper {
 public:
  Sweeper(State& state, std::uint32_t first_stamp) : state_(state), stamp_(first_stamp) {}

  /// Collapses if nothing forbids it and it costs at most `max_cost`; appends to steps() and merges().
  bool try_collapse(Candidate candidate, float max_cost);

  std::vector<Step>& steps() { return steps_; }
  std::vector<WedgeMerge>& merges() { return merges_; }
  std::uint32_t stamp() const { return stamp_; }

 private:
  struct Corner {
    std::uint32_t a, b;  // the triangle is (self, a, b), remapped
    std::uint32_t triangle;
  };
  void gather(std::uint32_t v, std::vector<Corner>& corners) const;
  bool refresh(Candidate& candidate) const;
  bool link_allows(const Candidate& candidate);
  bool flips(const std::vector<Corner>& corners, std::uint32_t self, std::uint32_t other, Vec3f to) const;
  bool pair_wedges(const Candidate& candidate, bool moved);
  std::uint32_t nearest_normal(std::uint32_t wedge, std::uint32_t chart) const;
  float plane_distance(const Candidate& candidate) const;
  void commit(const Candidate& candidate, bool moved, std::size_t first_merge);

  State& state_;
  std::uint32_t stamp_;
  std::size_t shared_ = 0;  // triangles that vanish
  std::vector<Corner> kept_corners_, removed_corners_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;  // wedge of removed, wedge of kept
  std::vector<std::uint32_t> kept_wedges_;
  std::vector<Step> steps_;
  std::vector<WedgeMerge> merges_;
};

/// One pass: costs of all edges, the cheapest `share` of them tried in order. Appends what was done to `steps` and
/// `merges` and compacts the mesh. Returns the number of collapses.
std::size_t run_pass(State& state, double share, std::vector<Step>& steps, std::vector<WedgeMerge>& merges,
                     const Task& task);

}  // namespace lodestone::simplify::detail
