// The working mesh of an edge-collapse run: flat arrays, compacted after every pass.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/collapse_log.h"
#include "lodestone/core/mesh.h"
#include "lodestone/math/float4.h"
#include "lodestone/simplify/collapse/edge_collapse.h"

namespace lodestone::simplify::detail {

/// Rows a, b, c, d become columns.
inline void transpose(Float4& a, Float4& b, Float4& c, Float4& d) {
  const Float4 ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5), ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Float4 cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5), cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  c = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

/// What a vertex may do. A *feature edge* is a border, a seam, an edge between two face groups or a non-manifold edge.
/// The class never changes: features collapse only along themselves.
enum class VertexClass : std::uint8_t {
  interior,  ///< on no feature edge, one closed fan: may move and vanish
  feature,   ///< on exactly two feature edges that every fan joins: may move and vanish along them
  no_move,   ///< where features meet or end, bow-ties, locked by request: stays; others may collapse into it
};

/// Why a vertex is fixed, for LockCounts.
enum class LockCause : std::uint8_t { none, border, seam_corner, non_manifold, by_request };

/// Cross product of a triangle's sides, and the inverse root of its length (0 for a triangle without area).
struct alignas(16) TriangleNormal {
  Vec3f n;
  float inverse_root = 0;
};
inline TriangleNormal weighed_normal(Vec3f n) {
  const float l = length(n);
  return {n, l > 0 ? 1 / std::sqrt(l) : 0};
}
inline TriangleNormal triangle_normal(Vec3f a, Vec3f b, Vec3f c) { return weighed_normal(cross(b - a, c - a)); }

/// Sum over a vertex's triangles about the vertex itself, where all linear terms vanish (memoryless, Lindstrom & Turk
/// 1998). Each triangle counts n n^T / sqrt(|n|), n being its cross product: squared distance times twice the area to
/// the power of 1.5. 48 bytes.
struct alignas(16) Quadric {
  float xx = 0, yy = 0, zz = 0, x = 0;  // x, y, z: the vertex
  float xy = 0, yz = 0, zx = 0, y = 0;
  Vec3f volume;  ///< sum of n: moving the vertex by d changes the volume by (volume . d) / 6
  float z = 0;

  Vec3f position() const { return {x, y, z}; }
};

/// A direction to within half a degree, 3 bytes.
class PackedDirection {
 public:
  PackedDirection() = default;
  explicit PackedDirection(Vec3f n) {
    const float l = length(n);
    const float scale = l > 0 ? 127 / l : 0;
    x_ = static_cast<std::int8_t>(n.x * scale);
    y_ = static_cast<std::int8_t>(n.y * scale);
    z_ = static_cast<std::int8_t>(n.z * scale);
  }
  float dot(Vec3f n) const {
    return static_cast<float>(x_) * n.x + static_cast<float>(y_) * n.y + static_cast<float>(z_) * n.z;
  }

 private:
  std::int8_t x_ = 0, y_ = 0, z_ = 0;
};

/// One accepted collapse, in the working frame.
struct Step {
  std::uint32_t kept, removed;  ///< vertices of the input mesh
  Vec3f position;               ///< of `kept`, working frame; unused when !moved
  float error;  ///< how far the surface and its attributes are from the input here, about; working frame
  std::uint32_t first_wedge, wedge_count;
  std::uint32_t faces;
  std::uint32_t order;  ///< place in the pass's record: never below that of a step that this one builds on
  bool moved;
};

/// What a pass notes about a vertex. 16 bytes.
struct Notes {
  std::uint32_t mark = 0;        ///< scratch of the link condition
  std::uint32_t touched_at = 0;  ///< collapse that last changed its star or a position in it
  std::uint32_t merged_at = 0;   ///< collapse that last merged a vertex into it; kNone once it has gone itself
  std::uint16_t order = 0;       ///< largest Step::order around it
  bool stale = false;            ///< its quadric is not that of its star
};

/// Where in the division of work a vertex lies.
enum Zone : std::uint8_t {
  kInFirst = 1,   ///< its whole ring is in its range of the first cut, so nobody else meets it there
  kInSecond = 2,  ///< the same of the second cut, half a range on
  kHeavy = 4,     ///< has more than kMaxValence triangles
};

/// A triangle as a vertex sees it: (the vertex, a, b) in its direction.
struct Corner {
  std::uint32_t a, b, triangle;
};

/// The attributes that have a say in what collapses, see attributes_detail.h. All by wedge of the input.
struct AttributeField {
  std::size_t blocks = 0;        ///< groups of four numbers a wedge; 0 = none has a say
  std::size_t uv_sets = 0;       ///< these come first, two numbers each
  std::vector<Float4> values;    ///< as they are at any moment, in lengths of the working frame
  std::vector<Float4> quadrics;  ///< `stride` a wedge: xx xy xz yy, yz zz area 0, then x, y, z of area times gradient

  std::size_t stride() const { return blocks == 0 ? 0 : 2 + 3 * blocks; }
};

/// Triangles around a vertex: each a triangle's number times 4, plus which of its corners the vertex is.
struct StarRef {
  std::uint32_t* entries = nullptr;
  std::uint32_t count = 0, capacity = 0;
};

/// Room for stars that outgrow the place that they had. What it gave lives as long as it does.
class StarArena {
 public:
  std::uint32_t* take(std::size_t size) {
    if (size > left_) {
      left_ = std::max<std::size_t>(size, 4096);
      blocks_.push_back(std::make_unique_for_overwrite<std::uint32_t[]>(left_));
      next_ = blocks_.back().get();
    }
    left_ -= size;
    return std::exchange(next_, next_ + size);
  }

 private:
  std::vector<std::unique_ptr<std::uint32_t[]>> blocks_;
  std::uint32_t* next_ = nullptr;
  std::size_t left_ = 0;
};

struct State {
  // The frame: working position = metric * (position - center) / scale, scale a power of two near the mean edge length.
  Vec3d center;
  Mat4d metric, metric_inverse;
  double scale = 1;
  float rounding = 0;  ///< what positions are rounded by, about; working frame

  // The mesh as it is at any moment, compacted between passes. Vertices keep a space-filling order, triangles that of
  // their lowest vertices, so that neighbours are near in memory. A triangle that has vanished names kNone.
  std::vector<Vec3f> positions;
  std::vector<VertexClass> classes;
  std::vector<float> accumulated_error;        ///< how far the surface here is from the input, about; working frame
  std::vector<float> weights;                  ///< EdgeCollapseOptions::weights; empty = 1
  std::vector<std::uint32_t> original;         ///< vertex of the input mesh
  std::vector<Triangle> triangles;             ///< vertices
  std::vector<TriangleNormal> normals;         ///< of the triangles, zero for vanished ones; one more at the end, zero
  std::vector<PackedDirection> first_normals;  ///< of the triangles, as the input has them
  std::vector<Triangle> wedges;                ///< wedges of the input mesh; empty when the run need not know them
  std::vector<std::uint32_t> groups;           ///< face group of each triangle; empty when there is one
  /// Triangles that stand for their back, too: an input triangle on the same wedges turned the other way, which follows
  /// wherever this one goes. Empty when there is none.
  std::vector<std::uint8_t> has_back;
  std::size_t backs = 0;

  // About the input's wedges; empty as above.
  std::vector<std::uint32_t> chart;  ///< class of each wedge with normals and tangents left out: a change is a seam
  std::vector<Vec3f> wedge_normals;  ///< of the input; empty when it has none
  AttributeField attributes;

  std::vector<std::uint32_t> dropped;  ///< input triangles that take no part
  std::vector<LockCause> causes;       ///< one a vertex of the input

  // Rebuilt every pass.
  std::vector<StarRef> stars;              ///< one a vertex, of live triangles alone
  std::vector<std::uint32_t> star_memory;  ///< where the stars are that the pass began with
  std::vector<Quadric> quadrics;
  std::vector<std::uint8_t> zone;  ///< bits of Zone
  std::vector<Notes> notes;
  float error_weight = 0;  ///< what the accumulated error, squared, costs

  float fold_cosine = 0;  ///< EdgeCollapseOptions::fold_cosine

  float weight_of(std::uint32_t v, std::uint32_t w) const {
    return weights.empty() ? 1.0F : std::max(weights[v], weights[w]);
  }
  /// What it costs to merge two vertices where the distances to the planes around have this mean square: the largest is
  /// some 1.5 times its root. The sweep knows better when it gets there, but most turns then come when they should.
  float cost_of_error(std::uint32_t v, std::uint32_t w, float mean_square) const {
    const float most = std::max(accumulated_error[v], accumulated_error[w]) + 1.5F * std::sqrt(mean_square);
    return error_weight * most * most;
  }
  std::span<const std::uint32_t> star_of(std::uint32_t v) const { return {stars[v].entries, stars[v].count}; }
};

/// Vertices with more triangles than this take no part in a pass, which bounds its time; other vertices are free to
/// collapse around them.
inline constexpr std::size_t kMaxValence = 512;

/// Star entries have two bits for the corner.
inline constexpr std::size_t kMaxTriangles = (std::size_t{1} << 30) - 1;

/// Builds the working mesh: frame, order, classes, stars. Errors: cancelled.
Result<State> make_state(const Mesh& mesh, const EdgeCollapseOptions& options, const Task& task);

/// Fills classes and causes from the working mesh.
void classify_vertices(State& state, const EdgeCollapseOptions& options, const Task& task);

/// Builds the stars from triangles, and what the pass knows of vertices. O(triangles).
void build_stars(State& state, const Task& task);

/// The triangles around a vertex. `memory` is where they go.
std::span<const Corner> gather(const State& state, std::uint32_t v, std::vector<Corner>& memory);

/// Finds what follows what around a vertex of up to 16 triangles.
class Fan {
 public:
  /// False = too many.
  bool load(std::span<const Corner> corners) {
    size_ = corners.size();
    if (size_ > 16) return false;
    auto* lanes = reinterpret_cast<std::uint32_t*>(b_.data());
    for (std::size_t i = 0; i < size_; ++i) lanes[i] = corners[i].b;
    for (std::size_t i = size_; i % 4 != 0; ++i) lanes[i] = kNone;
    return true;
  }
  /// The corner whose b is `a`; kNone unless there is exactly one.
  std::uint32_t before(std::uint32_t a) const {
    constexpr int kOne = 1 << 16;  // counts matches above their place
    const int wanted = static_cast<int>(a);
    const Int4 four{wanted, wanted, wanted, wanted};
    Int4 place{kOne, kOne + 1, kOne + 2, kOne + 3}, sum{};
    for (std::size_t block = 0; 4 * block < size_; ++block) {
      sum += (b_[block] == four) & place;
      place += 4;
    }
    const int found = sum[0] + sum[1] + sum[2] + sum[3];
    return found >> 16 == 1 ? static_cast<std::uint32_t>(found & 0xffff) : kNone;
  }

 private:
  std::array<Int4, 4> b_;
  std::size_t size_ = 0;
};

/// The wedge of a triangle at one of its vertices.
inline std::uint32_t wedge_at(const State& state, std::uint32_t triangle, std::uint32_t vertex) {
  const Triangle& v = state.triangles[triangle];
  const Triangle& w = state.wedges[triangle];
  return v[0] == vertex ? w[0] : v[1] == vertex ? w[1] : w[2];
}

/// True if the edge is a feature: not exactly two triangles, or these differ in group or in a chart at one end.
/// `triangles` are those with both a and b.
bool is_feature_edge(const State& state, std::uint32_t a, std::uint32_t b, std::span<const std::uint32_t> triangles);

/// Makes the quadric of a vertex anew from its star as it is, and those of its wedges. Feature vertices get the lines
/// of their feature edges, too.
void renew_quadric(State& state, std::uint32_t v);

}  // namespace lodestone::simplify::detail
