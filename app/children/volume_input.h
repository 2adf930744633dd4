// Volumes as inputs: the options that say how one is read, and its surface as a model.
#pragma once

#include <filesystem>
#include <string>

#include "app/options/axes.h"
#include "app/options/command_line.h"
#include "app/options/shared_options.h"
#include "app/options/spec.h"
#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/scans/scan_surface.h"
#include "lodestone/chain/voxels/volume_surface.h"
#include "lodestone/io/volumes/read.h"

namespace lodestone::app {

/// --iso, --labels, --smooth, --median, --series, --raw and what belongs to it.
OptionGroup volume_group();
/// --scan-resolution, --close, --splat: how points become a surface. `close` is false for verbs that have it anyway.
OptionGroup scan_group(bool close);

struct VolumeRequest {
  io::VolumeReadOptions read;
  chain::VolumeSurfaceOptions surface;
  chain::ScanSurfaceOptions scan;
  std::vector<LengthArgument> close;  ///< --close for a scan; empty = by the scan
  LengthRules lengths;                ///< --unit: what a scan's numbers are
  UpAxis up = UpAxis::unsaid;         ///< --up
  bool asked = false;                 ///< by --iso, --labels or --raw: whatever the input is called, it is a volume
};

/// Errors: bad_argument.
Result<VolumeRequest> volume_request(const Arguments& arguments);

/// Whether a path is read as a volume: by request, by its ending, or as a folder of slices.
bool is_volume(const std::filesystem::path& path, const VolumeRequest& request);

/// Whether a path holds points alone, by its ending and first bytes.
bool is_scan(const std::filesystem::path& path);

/// Reads points and makes their surface. Errors: those of io::read_points and chain::surface_of_scan; bad_argument
/// (--close).
Result<Model> read_scan_model(const std::filesystem::path& path, const VolumeRequest& request, Task task);

/// Reads a volume in a process of its own and makes its surface. Errors: those of io::read_volume and
/// chain::surface_of.
Result<Model> read_volume_model(const std::filesystem::path& path, const VolumeRequest& request, Task task);

}  // namespace lodestone::app
