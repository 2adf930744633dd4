// What the readers of point clouds share.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/point_cloud.h"
#include "lodestone/io/byte_reader_detail.h"

namespace lodestone::io {

/// Points as a file has them.
struct RawPoints {
  std::vector<Vec3d> positions;
  std::vector<Vec3f> normals;                       ///< one a point, or none
  std::vector<std::array<std::uint8_t, 4>> colors;  ///< one a point, or none
  std::vector<std::string> warnings;
};

/// How a reader ends: leaves out what is not finite, chooses the offset, puts normals right. Errors: empty.
Result<PointCloud> finish_points(RawPoints raw, std::string_view name);

/// The error of more points than can be named.
tl::unexpected<Error> too_many_points(std::uint64_t count, std::string place);

Result<PointCloud> read_ply_points(ByteReader bytes, const Task& task);
Result<PointCloud> read_text_points(ByteReader bytes, const Task& task);
Result<PointCloud> read_pcd(ByteReader bytes, const Task& task);
Result<PointCloud> read_las(ByteReader bytes, const Task& task);

/// Whether a PLY's header, which begins `head` and ends in it, names vertices and no faces.
bool ply_names_only_points(std::string_view head);

/// Unpacks LZF (Marc Lehmann's LibLZF format) into exactly into.size() bytes. False: damaged, or of another size.
bool unpack_lzf(std::span<const char> packed, std::span<char> into);

}  // namespace lodestone::io
