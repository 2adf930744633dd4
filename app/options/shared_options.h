// Option groups that several verbs share, so that what means the same is spelled the same; and their values, read once.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/options/command_line.h"
#include "app/options/spec.h"
#include "lodestone/chain/ladder/effort.h"
#include "lodestone/core/model.h"
#include "lodestone/io/write.h"
#include "lodestone/measure/distance.h"
#include "lodestone/measure/screen.h"

namespace lodestone::app {

OptionGroup ladder_target_group();  ///< --levels, --ratio, --triangles, --error, --pixels, --distances (build)
OptionGroup view_group();           ///< --height, --fov
OptionGroup single_target_group();  ///< --ratio, --triangles, --error (simplify)
OptionGroup effort_group();         ///< --effort
OptionGroup length_group();         ///< --unit, --absolute
OptionGroup unit_group();           ///< --unit
OptionGroup measuring_group(std::uint64_t samples);  ///< --samples, --seed
OptionGroup with_bounded(OptionGroup group);         ///< and --bounded (measure)
OptionGroup with_image_error(OptionGroup group);     ///< and --image-error (build)
OptionGroup attribute_group();                       ///< --attributes, --uv-set
OptionGroup image_group();                           ///< --image, --views, --heat
OptionGroup output_group(bool compress);             ///< -o, --compress, --json
OptionGroup input_level_group(const char* text);     ///< --level
OptionGroup with_report(OptionGroup group);          ///< and --report (build)
OptionGroup result_group();                          ///< --json alone
OptionGroup general_group();                         ///< --threads, --quiet, --verbose, --help

/// More levels than these are no ladder but a slip of the keyboard.
inline constexpr std::uint64_t kMostLevels = 32;

/// Which of `targets` is given; empty = none. Errors: bad_argument with `remedy` (more than one).
Result<std::string> given_target(const Arguments& arguments, const std::vector<std::string>& targets,
                                 const std::string& remedy);

/// A length as typed, to be turned into model units once the model is known.
struct LengthArgument {
  std::string text;
  double value = 0;
  enum class Kind { relative, model_units, metres } kind = Kind::relative;
};

/// How lengths are to be read: --unit and --absolute.
struct LengthRules {
  double meters_per_unit = 0;  ///< of --unit; 0 = not given
  bool absolute = false;
};

Result<LengthRules> length_rules(const Arguments& arguments);
/// --effort, or what stands for it where it is not given.
chain::Effort effort_of(const Arguments& arguments, chain::Effort otherwise);

/// What a bare number means.
enum class BareLength { relative, model_units };
Result<std::vector<LengthArgument>> length_list(const Arguments& arguments, std::string_view option,
                                                const LengthRules& rules, BareLength bare = BareLength::relative);
/// Model units. Errors: bad_argument (a unit, and the model has none).
Result<std::vector<double>> to_model_units(const std::vector<LengthArgument>& lengths, const Model& model,
                                           double diagonal);

/// Warns of bare numbers that mean more than a tenth of the diagonal, which is mostly a slip: 1 for 1% or 1mm.
void doubt_lengths(std::string_view option, const std::vector<LengthArgument>& lengths, const Model& model,
                   std::vector<std::string>& warnings);

/// "10%" and "0.1" are both a tenth. Each in (0, 1).
Result<std::vector<double>> ratio_list(const Arguments& arguments, std::string_view option);

Result<measure::DistanceOptions> distance_options(const Arguments& arguments);
Result<measure::View> view_of(const Arguments& arguments);
io::Compression compression_of(const Arguments& arguments);
/// Sets the model's unit from --unit.
void apply_unit(Model& model, const LengthRules& rules);
/// "m", "mm", …; empty when the model has none.
std::string unit_name(double meters_per_unit);

}  // namespace lodestone::app
