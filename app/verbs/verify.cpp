#include "app/verbs/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/output/text.h"
#include "lodestone/base/units.h"
#include "lodestone/io/read.h"

namespace lodestone::app {
namespace {

// Two certified bounds of one distance are within a hundredth of it each; what was only found depends on the samples.
// Coordinates are written with the precision of the format, which shows in levels that are all but exact.
constexpr double kBounds = 0.02, kFound = 0.15, kRounding = 4e-6;

tl::unexpected<Error> not_as_told(const LevelReport& level, std::string what) {
  return fail(ErrorCode::bad_format, fmt::format("level {}: {}", level.level, what), level.file,
              "don't rely on this file, and report what made it: it should not be possible");
}

Result<Model> read_level(const BuildReport& report, std::size_t level, const Task& task) {
  const bool one_file = report.levels.front().file == report.levels.back().file;
  io::ReadOptions options;
  options.draw_level = one_file ? level : 0;
  return io::read_model(report.levels[level].file, options, task);
}

// The error read back over the error told, less what rounding explains, as a share of the larger.
Result<double> difference(const LevelReport& level, const measure::Distance& found) {
  const double told = level.error.relative(level.error.measured_error), now = found.relative(found.trusted_max());
  const double off = std::max(0.0, std::abs(now - told) - kRounding);
  const bool certain = level.error.kind == ErrorKind::bounded && found.is_bounded;
  const double share = off > 0 ? off / std::max(now, told) : 0;
  if (share <= (certain ? kBounds : kFound)) return share;
  return not_as_told(
      level, fmt::format("an error of {} of the diagonal was told, read back it is {}", percent(told), percent(now)));
}

}  // namespace

Result<VerifyReport> verify_levels(const BuildReport& report, const measure::DistanceOptions& distance,
                                   const Task& task) {
  const double share = 1.0 / static_cast<double>(report.levels.size());
  const Result<Model> original = read_level(report, 0, task.part(share / 2));
  LODESTONE_TRY(original);
  if (drawn_triangles(*original) != report.triangles) {
    return not_as_told(report.levels.front(),
                       fmt::format("{} triangles were written, read back they are {}",
                                   with_separators(report.triangles), with_separators(drawn_triangles(*original))));
  }
  const Result<measure::Reference> reference = measure::Reference::create(*original, task.part(share / 2));
  LODESTONE_TRY(reference);
  VerifyReport out;
  for (std::size_t k = 1; k < report.levels.size(); ++k) {
    const LevelReport& level = report.levels[k];
    if (level.triangles == 0) continue;
    const Result<Model> model = read_level(report, k, task.part(share / 4));
    LODESTONE_TRY(model);
    if (drawn_triangles(*model) != level.triangles) {
      return not_as_told(level,
                         fmt::format("{} triangles were told, read back they are {}", with_separators(level.triangles),
                                     with_separators(drawn_triangles(*model))));
    }
    const Result<measure::Distance> found = reference->distance_to(*model, distance, task.part(share * 3 / 4));
    LODESTONE_TRY(found);
    const Result<double> off = difference(level, *found);
    LODESTONE_TRY(off);
    out.largest_difference = std::max(out.largest_difference, *off);
    ++out.levels;
  }
  return out;
}

}  // namespace lodestone::app
