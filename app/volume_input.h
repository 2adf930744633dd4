// Volumes as inputs: the options that say how one is read, and its surface as a model.
#pragma once

#include <filesystem>
#include <string>

#include "app/command_line.h"
#include "app/spec.h"
#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/volume_surface.h"
#include "lodestone/io/volume.h"

namespace lodestone::app {

/// --iso, --labels, --smooth, --median, --series, --raw and what belongs to it.
OptionGroup volume_group();

struct VolumeRequest {
  io::VolumeReadOptions read;
  chain::VolumeSurfaceOptions surface;
  bool asked = false;  ///< by --iso, --labels or --raw: whatever the input is called, it is a volume
};

/// Errors: bad_argument.
Result<VolumeRequest> volume_request(const Arguments& arguments);

/// Whether a path is read as a volume: by request, by its ending, or as a folder of slices.
bool is_volume(const std::filesystem::path& path, const VolumeRequest& request);

/// Reads a volume in a process of its own and makes its surface. Errors: those of io::read_volume and
/// chain::surface_of.
Result<Model> read_volume_model(const std::filesystem::path& path, const VolumeRequest& request, Task task);

}  // namespace lodestone::app
