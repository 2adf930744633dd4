// What `lod build` was asked, before any model is read: the targets, and which input goes to which output.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/children/volume_input.h"
#include "app/options/constraints.h"
#include "app/options/shared_options.h"
#include "app/options/voxel_method.h"
#include "lodestone/chain/ladder/build_ladder.h"
#include "lodestone/report/html_report.h"

namespace lodestone::app {

struct BuildPlan {
  std::size_t levels = 0;  ///< 0 = one of the lists below rules
  std::vector<double> ratios;
  std::vector<std::size_t> triangles;
  std::vector<LengthArgument> errors;
  std::vector<LengthArgument> distances;
  double pixels = 1;
  measure::View view;
  LengthRules lengths;
  chain::Effort effort = chain::Effort::normal;
  ConstraintPlan constraints;
  measure::DistanceOptions distance;
  VolumeRequest volume;
  std::optional<chain::VoxelLadderOptions> voxel;  ///< --method voxel
  bool force = false;                              ///< --force
  bool verify = false;                             ///< --verify
  bool image_error = false;                        ///< --image-error
  bool report = false;                             ///< --report
  std::vector<report::ReportOption> options;       ///< all that was asked, for the report
  io::Compression compression = io::Compression::none;
};

/// Errors: bad_argument (two targets, a value out of range).
Result<BuildPlan> build_plan(const Arguments& arguments);

/// Levels that a ladder has when it does not end early, with level 0.
std::size_t planned_levels(const BuildPlan& plan);

/// The options for one model. `notes` gets what a user should know, such as "keeping 10 %"; `warnings` what does not
/// fit the model.
Result<chain::LadderOptions> ladder_options(const BuildPlan& plan, const Model& model, std::vector<std::string>& notes,
                                            std::vector<std::string>& warnings, const Task& task);

struct BuildJob {
  std::filesystem::path input, output;
  std::filesystem::path report;  ///< empty: none
};

struct BuildJobs {
  std::vector<BuildJob> jobs;
  bool batch = false;            ///< several inputs or a directory: the result is a list
  std::filesystem::path folder;  ///< to be made if missing; empty = none
};

/// Lists directories and names the outputs. Errors: bad_argument (no output, an output that is an input, two inputs for
/// one output), cannot_read, cannot_write, empty.
Result<BuildJobs> build_jobs(const Arguments& arguments, const VolumeRequest& volume);

}  // namespace lodestone::app
