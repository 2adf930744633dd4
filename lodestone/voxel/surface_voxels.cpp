#include "lodestone/voxel/surface_voxels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/core/validate.h"
#include "lodestone/voxel/morphology.h"

namespace lodestone::voxel {

namespace {

constexpr std::uint32_t kSlab = 8;  // slices that belong to one thread

// A triangle in voxel coordinates, where voxel (x, y, z) is the box from there to one more.
struct Placed {
  std::array<Vec3d, 3> corner;
  std::array<std::uint32_t, 3> low{}, high{};  // voxels of its box
};

// A line of the triangle's projection: a + u x + v y is above 0 where a voxel's square may meet it.
struct Line {
  double a, u, v;
};

// The tests of one triangle against voxels, for their low corners.
class Overlap {
 public:
  Overlap(const Placed& t, Thickness thickness) {
    const Vec3d e[3] = {t.corner[1] - t.corner[0], t.corner[2] - t.corner[1], t.corner[0] - t.corner[2]};
    normal_ = cross(e[0], e[1]);
    const Vec3d n{std::abs(normal_.x), std::abs(normal_.y), std::abs(normal_.z)};
    const bool thin = thickness == Thickness::separating_6;
    reach_ = thin ? std::max({n.x, n.y, n.z}) / 2 : (n.x + n.y + n.z) / 2;
    offset_ = dot(normal_, Vec3d{0.5, 0.5, 0.5} - t.corner[0]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      const double facing = normal_[axis] < 0 ? -1 : 1;
      for (std::size_t k = 0; k < 3; ++k) {
        const double nu = -e[k][v] * facing, nv = e[k][u] * facing;
        const double wide = thin ? std::max(std::abs(nu), std::abs(nv)) / 2 : (std::abs(nu) + std::abs(nv)) / 2;
        lines_[axis][k] = {nu * (0.5 - t.corner[k][u]) + nv * (0.5 - t.corner[k][v]) + wide, nu, nv};
      }
    }
  }

  bool touches(double x, double y, double z) const {
    if (std::abs(normal_.x * x + normal_.y * y + normal_.z * z + offset_) > reach_) return false;
    return inside(lines_[0], y, z) && inside(lines_[1], z, x) && inside(lines_[2], x, y);
  }

 private:
  static bool inside(const std::array<Line, 3>& lines, double u, double v) {
    return lines[0].a + lines[0].u * u + lines[0].v * v >= 0 && lines[1].a + lines[1].u * u + lines[1].v * v >= 0 &&
           lines[2].a + lines[2].u * u + lines[2].v * v >= 0;
  }
  Vec3d normal_;
  double offset_ = 0, reach_ = 0;
  std::array<std::array<Line, 3>, 3> lines_{};
};

// False where it lies outside of the grid.
bool place(const spatial::Surface& surface, std::size_t triangle, const VoxelGrid& grid, Placed& out) {
  const auto corners = surface.corners(triangle);
  for (std::size_t k = 0; k < 3; ++k) {
    double low = 1e300, high = -1e300;
    for (std::size_t c = 0; c < 3; ++c) {
      out.corner[c][k] = (corners[c][k] - grid.origin[k]) / grid.spacing[k];
      low = std::min(low, out.corner[c][k]);
      high = std::max(high, out.corner[c][k]);
    }
    if (!(high >= 0 && low < grid.size[k])) return false;
    out.low[k] = low <= 0 ? 0 : static_cast<std::uint32_t>(low);
    // A triangle on the side of two voxels touches both.
    if (low > 0 && low == std::floor(low)) --out.low[k];
    out.high[k] = std::min(grid.size[k] - 1, static_cast<std::uint32_t>(high));
  }
  return true;
}

void set_voxels(const Placed& t, Thickness thickness, std::uint32_t first, std::uint32_t last, BitVolume& volume) {
  const Overlap overlap(t, thickness);
  for (std::uint32_t z = std::max(first, t.low[2]); z <= std::min(last, t.high[2]); ++z) {
    for (std::uint32_t y = t.low[1]; y <= t.high[1]; ++y) {
      for (std::uint32_t x = t.low[0]; x <= t.high[0]; ++x) {
        if (overlap.touches(x, y, z)) volume.set(x, y, z);
      }
    }
  }
}

}  // namespace

Result<BitVolume> surface_voxels(const spatial::Surface& surface, const VoxelGrid& grid, Thickness thickness,
                                 Task task) {
  if (grid.count() == 0 || *std::max_element(grid.size.begin(), grid.size.end()) > 65'535) {
    return fail(ErrorCode::bad_argument,
                fmt::format("a grid of {} x {} x {} voxels can't be", grid.size[0], grid.size[1], grid.size[2]));
  }
  LODESTONE_TRY(validate(grid));
  LODESTONE_TRY(validate(surface, task));
  BitVolume volume(grid);
  std::vector<std::vector<std::uint32_t>> slabs((grid.size[2] + kSlab - 1) / kSlab);
  Placed placed;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    if ((t & 0xffff) == 0 && task.cancelled()) return cancelled_error("voxelizing");
    if (!place(surface, t, grid, placed)) continue;
    for (std::uint32_t s = placed.low[2] / kSlab; s <= placed.high[2] / kSlab; ++s) slabs[s].push_back(t);
  }
  parallel_for(slabs.size(), 1, task, [&](std::size_t s, std::size_t, std::size_t) {
    const std::uint32_t first = static_cast<std::uint32_t>(s) * kSlab;
    const std::uint32_t last = std::min(first + kSlab, grid.size[2]) - 1;
    Placed here;
    for (const std::uint32_t t : slabs[s]) {
      if (place(surface, t, grid, here)) set_voxels(here, thickness, first, last, volume);
    }
  });
  if (task.cancelled()) return cancelled_error("voxelizing");
  return volume;
}

Result<BitVolume> shrinkwrap(const spatial::Surface& surface, const VoxelGrid& grid, double radius, Task task) {
  if (!(radius >= 0 && radius <= 170)) {
    return fail(ErrorCode::bad_argument, fmt::format("a radius of {:.4g} voxels can't be closed", radius), {},
                "use 0 to 170: lower the resolution or the radius");
  }
  Result<BitVolume> walls = surface_voxels(surface, grid, Thickness::conservative, task);
  if (!walls) return walls;
  const auto reach = static_cast<std::uint32_t>(std::ceil(radius)) + 1;
  const BitVolume outside = flooded_from_outside(within(distances_sq(*walls, reach, task), radius, task));
  if (task.cancelled()) return cancelled_error("voxelizing");
  BitVolume solid = complement(within(distances_sq(outside, reach, task), radius, task));
  for (std::size_t w = 0; w < solid.words.size(); ++w) solid.words[w] |= walls->words[w];
  if (task.cancelled()) return cancelled_error("voxelizing");
  return solid;
}

}  // namespace lodestone::voxel
