// Joining: borders of different parts that lie near each other get the same positions, so that exact welding sews the
// parts together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"

namespace lodestone::spatial {

/// Pairs of border vertices of different parts that are each other's nearest, within `tolerance`: one of a pair takes
/// the place of the other (the higher that of the lower, none that of `locked`, one entry a vertex); in rounds, so that
/// corners of several parts fall together. No vertex moves farther than the tolerance, and none to another of its own
/// part. What exact welding then makes of a welded mesh has
/// - no edge that two of the joined triangles walk the same way, so none with more triangles than two that had fewer,
/// - no triangle that repeats another's vertices where none did before,
/// - no triangle turned by more than 90 degrees or left without area by joining,
/// - a sewn edge at every joined vertex: parts that would touch in a single point stay apart, as such a point could
///   never move again.
/// So closed parts, which have no border, are never joined. Returns how many vertices moved. O(n log n). Errors:
/// bad_argument (tolerance not above 0 or not finite, wrong size of `locked`), cancelled.
Result<std::size_t> join_parts(Mesh& mesh, double tolerance, const std::vector<std::uint8_t>& locked = {},
                               Task task = {});

}  // namespace lodestone::spatial
