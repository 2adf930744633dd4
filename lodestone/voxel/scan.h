// Scans: solids and signed distances from points.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/core/point_cloud.h"
#include "lodestone/core/volume.h"

namespace lodestone::voxel {

struct ScanOptions {
  std::uint32_t resolution = 256;  ///< voxels along the longest side, with the empty ones around the points
  /// Holes up to this radius are closed, model units. 0: twice the distance to the sixth neighbour that 98 % of the
  /// points have nearer. Two voxels at least, whatever is asked for.
  double close_radius = 0;
  double splat_radius = 0;       ///< scan_solid(): how much larger than closed the solid is to be, voxels, 0 to 8
  std::uint32_t neighbors = 12;  ///< scan_distance(): points that a distance is averaged from, 1 to 64
  std::uint64_t most_bytes = std::uint64_t{4} << 30;  ///< memory that may be used
};

/// What a scan's volume was made by.
struct ScanFigures {
  double spacing = 0;                ///< distance to the sixth nearest point, the median, model units
  double close_radius = 0;           ///< that was used, model units
  std::uint64_t surface_voxels = 0;  ///< that hold a point
  std::uint64_t open_voxels = 0;     ///< scan_distance(): where inside and outside meet without a point being near
  /// Holes larger than the radius: what should be inside is joined to the outside, so that the surface is (in parts) a
  /// thin shell around the points.
  bool open = false;
  double sheet_distance = 0;  ///< scan_distance(): for trim_to_points(), which then keeps a shell's side with points
  std::vector<std::string> warnings;  ///< in plain words, for the user
};

struct ScanSolid {
  BitVolume volume;
  ScanFigures figures;
};

struct ScanDistance {
  ScalarVolume<float> volume;  ///< model units, above 0 inside: isosurface() at 0 is the surface
  ScanFigures figures;
};

/// Bytes that scan_solid() and scan_distance() need for a grid and a number of points, the result included.
std::uint64_t scan_solid_bytes(const VoxelGrid& grid, std::uint64_t points);
std::uint64_t scan_distance_bytes(const VoxelGrid& grid, std::uint64_t points);

/// A solid from points alone, normals or not: the voxels that hold a point are grown by a ball of the radius, what
/// can't be reached from outside then is inside, and the ball's growth is taken back (a closing). So it reaches out to
/// the outermost voxels that hold points, half a voxel more than the points on average, and what no inside is enclosed
/// by stays a sheet one voxel thick. Same bits for any thread count. O(voxels · radius in voxels + n log n), memory 2.4
/// bytes a voxel and 36 a point. Errors: empty (no points), bad_argument (options out of range, a radius that is more
/// than a third of the longest side or above 170 voxels, points all in one place; those of validate()),
/// out_of_memory (more than most_bytes; the line says how much and which resolution fits), cancelled.
Result<ScanSolid> scan_solid(const PointCloud& cloud, const ScanOptions& options = {}, const Task& task = {});

/// Signed distances from points with normals that look outward: near the points the weighted mean of the distances to
/// the planes of the nearest ones (as H. Hoppe et al., Surface Reconstruction from Unorganized Points, SIGGRAPH 1992,
/// with several planes in place of one), elsewhere the sign of scan_solid() and a constant. Points whose normal is (0,
/// 0, 0) only tell where the surface is. The surface passes through the points, and holes are closed by planes. Memory
/// 6.6 bytes a voxel and 36 a point; errors as above, bad_argument also without normals.
Result<ScanDistance> scan_distance(const PointCloud& cloud, const ScanOptions& options = {}, const Task& task = {});

/// The triangles of a surface without those that have a corner farther than `most` (model units) from all points: of
/// the shell around an open scan the side that the points lie on, with borders; it may touch itself in single vertices.
/// Vertices that none uses are gone; no attributes. Same bytes for any thread count. O(vertices log points). Errors:
/// empty (no triangle left, no points), bad_argument (those of validate(), of both), cancelled.
Result<Mesh> trim_to_points(const Mesh& mesh, const PointCloud& cloud, double most, const Task& task = {});

}  // namespace lodestone::voxel
