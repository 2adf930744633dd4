#include "lodestone/voxel/cube_faces.h"

#include <bit>
#include <utility>
#include <vector>

#include "lodestone/core/validate.h"

namespace lodestone::voxel {

namespace {

// Corners of two planes of a volume, numbered when they are first used.
class Corners {
 public:
  Corners(const VoxelGrid& grid, Mesh& mesh)
      : grid_(grid),
        mesh_(mesh),
        width_(grid.size[0] + 1),
        low_(std::size_t{width_} * (grid.size[1] + 1), kNone),
        high_(low_) {}

  void next_plane() {
    std::swap(low_, high_);
    high_.assign(high_.size(), kNone);
    ++z_;
  }

  std::uint32_t at(std::uint32_t x, std::uint32_t y, bool high) {
    std::uint32_t& number = (high ? high_ : low_)[std::size_t{y} * width_ + x];
    if (number == kNone) {
      number = static_cast<std::uint32_t>(mesh_.positions.size());
      const Vec3d p = grid_.point({double(x), double(y), double(z_) + (high ? 1 : 0)});
      mesh_.positions.push_back(to_float(p - mesh_.offset));
    }
    return number;
  }

 private:
  const VoxelGrid& grid_;
  Mesh& mesh_;
  std::uint32_t width_, z_ = 0;
  std::vector<std::uint32_t> low_, high_;
};

// Four corners, counter-clockwise from outside.
void add_face(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

void add_voxel(const BitVolume& volume, std::uint32_t x, std::uint32_t y, std::uint32_t z, Corners& at, Mesh& mesh) {
  const auto& size = volume.grid.size;
  const auto corner = [&](unsigned i, unsigned j, unsigned k) { return at.at(x + i, y + j, k != 0); };
  if (x == 0 || !volume.at(x - 1, y, z))
    add_face(mesh, corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0));
  if (x + 1 == size[0] || !volume.at(x + 1, y, z))
    add_face(mesh, corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1));
  if (y == 0 || !volume.at(x, y - 1, z))
    add_face(mesh, corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1));
  if (y + 1 == size[1] || !volume.at(x, y + 1, z))
    add_face(mesh, corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1), corner(1, 1, 0));
  if (z == 0 || !volume.at(x, y, z - 1))
    add_face(mesh, corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0));
  if (z + 1 == size[2] || !volume.at(x, y, z + 1))
    add_face(mesh, corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1));
}

}  // namespace

Result<Mesh> cube_faces(const BitVolume& volume, Task task) {
  LODESTONE_TRY(validate(volume));
  const auto& size = volume.grid.size;
  Mesh mesh;
  mesh.offset = volume.grid.point({size[0] / 2.0, size[1] / 2.0, size[2] / 2.0});
  Corners corners(volume.grid, mesh);
  for (std::uint32_t z = 0; z < size[2]; ++z) {
    if (task.cancelled()) return cancelled_error("making cubes");
    for (std::uint32_t y = 0; y < size[1]; ++y) {
      for (std::size_t w = 0; w < volume.row_words; ++w) {
        for (std::uint64_t left = volume.words[volume.row_of(y, z) + w]; left != 0; left &= left - 1) {
          add_voxel(volume, static_cast<std::uint32_t>(w * 64) + static_cast<std::uint32_t>(std::countr_zero(left)), y,
                    z, corners, mesh);
        }
      }
    }
    if (mesh.positions.size() > kNone - 1 - 2 * (std::size_t{size[0]} + 1) * (size[1] + 1)) {
      return fail(ErrorCode::unsupported, "the cubes have more corners than a mesh can name", {},
                  "lower the resolution");
    }
    corners.next_plane();
  }
  if (mesh.triangles.empty()) return fail(ErrorCode::empty, "no voxel is set");
  return mesh;
}

}  // namespace lodestone::voxel
