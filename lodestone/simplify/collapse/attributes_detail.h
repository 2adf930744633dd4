// Attributes in an edge-collapse run: what a collapse costs them, and what values it leaves.
#pragma once

#include <cstdint>
#include <span>

#include "lodestone/simplify/collapse/state_detail.h"

namespace lodestone::simplify::detail {

/// Numbers a wedge that are weighed, at most; streams past that follow without a say.
inline constexpr std::size_t kMaxAttributeLanes = 64;

/// Fills State::attributes from the streams that count, each scaled to lengths of the working frame.
void take_attributes(State& state, const Mesh& mesh, const AttributeWeights& weights);

/// Makes the quadrics of all wedges of a vertex anew from its star.
void renew_attribute_quadrics(State& state, std::uint32_t v);

/// Two wedges that become one, and the vertices that they belong to.
struct AttributePair {
  std::uint32_t kept, removed;                // wedges
  std::uint32_t kept_vertex, removed_vertex;  // where they are now
  bool moved;                                 // false = the kept vertex stays, with its values
};

/// Squared deviation of attributes over the triangles of both wedges when they merge at `to`; each triangle is weighed
/// as for positions.
float attribute_cost(const State& state, const AttributePair& pair, Vec3f to);

/// The same for the wedges across an edge with these triangles.
float edge_attribute_cost(const State& state, std::uint32_t kept, std::uint32_t removed, bool moved, Vec3f to,
                          std::span<const std::uint32_t> triangles);

/// What a wedge's triangles weigh.
inline float wedge_weight(const AttributeField& field, std::uint32_t wedge) {
  return field.quadrics[wedge * field.stride() + 1][2];
}

/// The values that err least for a pair that merges at `to`.
void best_values(const State& state, const AttributePair& pair, Vec3f to, std::span<Float4> values);

/// Of the ways from the kept wedge's values to the removed one's and to those wanted: squared length of the first, dot
/// product of both.
struct Projection {
  float along_along, along_goal;
};
Projection project(const AttributeField& field, std::uint32_t kept, std::uint32_t removed,
                   std::span<const Float4> wanted);

/// How a wedge gets near the values wanted: first `to_removed` of the way to the removed wedge, then `to_third` of the
/// way to a third one, if any. Never outside of what the three span, so nothing leaves its range.
struct Blend {
  float to_removed = 0;
  std::uint32_t third = kNone;
  float to_third = 0;
};
Blend blend_towards(const AttributeField& field, std::uint32_t kept, std::uint32_t removed,
                    std::span<const std::uint32_t> thirds, std::span<const Float4> wanted);

/// True if a triangle, given as its corners' values, turns over in the texture of a UV set.
bool turns_uv(std::size_t set, std::span<const Float4* const> before, std::span<const Float4* const> after);

}  // namespace lodestone::simplify::detail
