#include "lodestone/chain/scans/scan_colors_detail.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lodestone/base/parallel.h"
#include "lodestone/core/srgb.h"

namespace lodestone::chain {

namespace {

constexpr std::size_t kNeighbors = 8;
constexpr std::size_t kWedgesAtOnce = 4096;

bool is_black(const std::array<std::uint8_t, 4>& c) { return c[0] == 0 && c[1] == 0 && c[2] == 0; }

// A point at the vertex itself counts four times as much as one that is `spacing` away.
Vec3d mean_light(const PointCloud& cloud, std::span<const spatial::Neighbor> near, double spacing) {
  const double soft_sq = spacing > 0 ? spacing * spacing / 3 : 1;
  Vec3d sum{};
  double weights = 0;
  for (const spatial::Neighbor& n : near) {
    const double weight = soft_sq / (soft_sq + n.distance_sq);
    const auto& c = cloud.colors[n.point];
    sum += Vec3d{light_of_byte(c[0]), light_of_byte(c[1]), light_of_byte(c[2])} * weight;
    weights += weight;
  }
  return weights > 0 ? sum * (1 / weights) : Vec3d{};
}

}  // namespace

void add_scan_colors(const PointCloud& cloud, const spatial::KdTree& tree, double spacing, Mesh& mesh,
                     std::vector<std::string>& warnings, const Task& task) {
  if (cloud.colors.empty()) return;
  if (std::all_of(cloud.colors.begin(), cloud.colors.end(), is_black)) {
    warnings.emplace_back("all points of the scan are black: their colours were left out");
    return;
  }
  AttributeStream stream = make_stream("COLOR_0", Semantic::color, 3, ComponentType::uint16, true, mesh.wedge_count());
  stream.is_light = true;
  auto& values = std::get<std::vector<float>>(stream.values);
  const std::size_t wedges = mesh.wedge_count();
  parallel_for(wedges, kWedgesAtOnce, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::array<spatial::Neighbor, kNeighbors> near{};
    for (std::size_t w = begin; w < end; ++w) {
      const Vec3d at = mesh.position(mesh.vertex_of(static_cast<std::uint32_t>(w))) - cloud.offset;
      const std::size_t count = tree.nearest(at, near);
      const Vec3d light = mean_light(cloud, std::span(near).first(count), spacing);
      for (std::size_t k = 0; k < 3; ++k) {
        values[3 * w + k] = static_cast<float>(std::floor(light[k] * 65535 + 0.5)) / 65535.0F;
      }
    }
    task.advance(static_cast<double>(end - begin) / static_cast<double>(wedges));
  });
  mesh.attributes.push_back(std::move(stream));
}

}  // namespace lodestone::chain
