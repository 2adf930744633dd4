// Reading point clouds: PLY without faces, text (XYZ, TXT, ASC, PTS), PCD and LAS.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/point_cloud.h"

namespace lodestone::io {

/// Reads a cloud by its extension (any case), checked against the content.
///
/// - PLY: `element vertex`; nx ny nz and red green blue [alpha] where there are any. Faces are left out (warning).
/// - XYZ, TXT, ASC, CSV, PTS: a point a line, x y z and what follows, separated by blanks, commas or semicolons; a
/// first
///   line of names or, in PTS, of counts is left out. Three columns of which all rows are unit vectors are normals;
///   three of whole numbers from 0 to 255 are colours; others are left out (warning).
/// - PCD 0.7: ascii, binary and binary_compressed; x y z, normal_x normal_y normal_z, rgb or rgba, red green blue.
/// - LAS 1.0 to 1.4, uncompressed: scale and offset, colours of the formats that have them. LAZ and COPC are refused
///   with a line that says how to convert.
///
/// Points with coordinates that are not finite are left out (warning); normals come out with length 1 or 0. Coordinates
/// far from the origin set PointCloud::offset. Errors: cannot_read, bad_format (with line or byte), unsupported
/// (another extension, compressed LAS, more than 2^32 - 2 points), empty (no point), out_of_memory, cancelled. Time
/// O(size); memory at most some 3 times the result.
Result<PointCloud> read_points(const std::filesystem::path& path, const Task& task = {});

/// The same from memory. `name` stands for the file in messages; its extension says the format.
Result<PointCloud> read_points(std::span<const std::byte> bytes, std::string_view name, const Task& task = {});

/// Whether a file is for read_points() rather than for read_model(): by its extension, and for PLY by the header in
/// `head`, the file's first bytes: it names vertices but no faces. False for a PLY whose header goes on behind `head`
/// (64 KiB hold any that is usual).
bool looks_like_points(const std::filesystem::path& path, std::string_view head);

}  // namespace lodestone::io
