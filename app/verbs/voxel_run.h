// What remesh and voxelize share: the request, reading, writing, the table.
#pragma once

#include <string>
#include <vector>

#include "app/children/volume_input.h"
#include "app/options/command_line.h"
#include "app/output/console.h"
#include "app/output/reports.h"
#include "lodestone/base/result.h"
#include "lodestone/base/stopwatch.h"
#include "lodestone/chain/voxels/solid.h"
#include "lodestone/chain/voxels/voxel_levels.h"
#include "lodestone/core/model.h"
#include "lodestone/io/write.h"

namespace lodestone::app {

struct VoxelRequest {
  std::string input, output;
  VolumeRequest volume;  ///< where the input is one
  io::Compression compression = io::Compression::none;
  bool json = false;
};

/// Checked before anything is read. Errors: bad_argument, cannot_write.
Result<VoxelRequest> voxel_request(const Arguments& arguments, const char* verb);

/// Reads the input and begins the report. Errors: those of reading; cannot_write (an output that is part of the input).
Result<Model> read_solid(const VoxelRequest& request, VoxelReport& report, const Console& console);

/// Fills in what is known of the solid.
void add_solid(VoxelReport& report, const chain::FillChoice& fill, const std::array<std::uint32_t, 3>& resolution,
               std::uint64_t voxels_inside);
void add_seconds(VoxelReport& report, const chain::VoxelSeconds& seconds);

/// Writes the result, ends the report (`watch` started before anything was read) and prints it, as JSON or a table.
/// Errors: those of writing.
Result<void> finish(const Model& model, const VoxelRequest& request, Stopwatch& watch, VoxelReport& report,
                    Console& console);

/// Tells warnings and keeps them.
void tell(VoxelReport& report, const std::vector<std::string>& warnings, const Console& console);

/// The error with the place where it has none.
Error with_place(Error error, const std::string& place);

}  // namespace lodestone::app
