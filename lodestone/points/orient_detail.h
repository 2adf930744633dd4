// Orientation of normals along a minimum spanning tree.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/math/vec.h"

namespace lodestone::points::detail {

/// The k nearest neighbours of n points, one row a point; rows may end early with kNobody.
struct Graph {
  static constexpr std::uint32_t kNobody = 0xffffffffU;
  std::size_t k = 0;
  std::vector<std::uint32_t> neighbors;

  std::size_t size() const { return k == 0 ? 0 : neighbors.size() / k; }
};

/// Turns normals around; returns how many pieces the graph has. Points are numbered so that near ones lie near each
/// other in memory, or it is slow.
std::uint64_t orient(const Graph& graph, std::span<const Vec3f> positions, std::span<Vec3f> normals, const Task& task);

}  // namespace lodestone::points::detail
