#include <cmath>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/voxel/caps_detail.h"
#include "lodestone/voxel/fill_winding_detail.h"
#include "lodestone/voxel/winding.h"
#include "lodestone/voxel/z_crossings_detail.h"

namespace lodestone::voxel::detail {

namespace {

// A winding number this far from a half is no matter of doubt.
constexpr double kMargin = 0.2;

// One column of voxels, cut where surface and caps cross it. Between two cuts the winding number of both is a whole
// number, and that of the caps changes smoothly.
class Column {
 public:
  Column(const WindingNumber& caps, BitVolume& volume, std::uint32_t x, std::uint32_t y)
      : caps_(caps), volume_(volume), x_(x), y_(y) {}

  // Slices first to last, both included.
  void fill(std::uint32_t first, std::uint32_t last, int whole) {
    whole_ = whole;
    const double at_first = at(first);
    fill_between(first, at_first, last, first == last ? at_first : at(last), true);
  }

 private:
  double at(std::uint32_t z) const {
    return std::abs(whole_ - caps_.at(volume_.grid.point({x_ + 0.5, y_ + 0.5, z + 0.5})));
  }

  // Ends that agree beyond doubt stand for all between them, once a middle has been looked at; else each half is.
  void fill_between(std::uint32_t first, double at_first, std::uint32_t last, double at_last, bool look) {
    const bool inside = at_first > 0.5;
    const bool agree =
        inside == (at_last > 0.5) && std::abs(at_first - 0.5) > kMargin && std::abs(at_last - 0.5) > kMargin;
    if (agree && !look) {
      if (inside) set(first, last);
    } else if (last - first < 2) {
      if (inside) set(first, first);
      if (at_last > 0.5) set(last, last);
    } else {
      const std::uint32_t middle = first + (last - first) / 2;
      const double at_middle = at(middle);
      fill_between(first, at_first, middle, at_middle, look && !agree);
      fill_between(middle, at_middle, last, at_last, look && !agree);
    }
  }

  void set(std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t z = first; z <= last; ++z) volume_.set(x_, y_, z);
  }

  const WindingNumber& caps_;
  BitVolume& volume_;
  std::uint32_t x_, y_;
  int whole_ = 0;
};

}  // namespace

void fill_winding(const spatial::Surface& surface, BitVolume& volume, const Task& task) {
  const VoxelGrid& grid = volume.grid;
  spatial::Surface closed = surface;
  const std::vector<Triangle> caps = caps_of(surface, task);
  closed.triangles.insert(closed.triangles.end(), caps.begin(), caps.end());
  const WindingNumber winding(closed.positions, caps, task);
  const std::vector<GridVertex> vertices = grid_vertices(closed, grid, task);
  const std::vector<Band> bands = bands_of(vertices, closed.triangles, grid, task);
  parallel_for(bands.size(), 1, task, [&](std::size_t i, std::size_t, std::size_t) {
    const Band& band = bands[i];
    const std::vector<Crossing> crossings = sorted_crossings(closed, vertices, band, grid);
    std::size_t next = 0;
    for (std::uint32_t y = band.first; y < band.end && !task.cancelled(); ++y) {
      for (std::uint32_t x = 0; x < grid.size[0]; ++x) {
        Column column(winding, volume, x, y);
        std::uint32_t first = 0;
        int whole = 0;  // faces that look to +z are left on the way out
        for (; next < crossings.size() && crossings[next].column == (y - band.first) * grid.size[0] + x; ++next) {
          const std::uint32_t cut = crossings[next].slice;
          if (cut > first) column.fill(first, cut - 1, whole);
          first = cut;
          whole -= crossings[next].sign;
        }
        if (first < grid.size[2]) column.fill(first, grid.size[2] - 1, whole);
      }
    }
  });
}

}  // namespace lodestone::voxel::detail
