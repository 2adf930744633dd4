#include "app/verbs/heat.h"

#include <fmt/format.h>

#include <filesystem>

#include "app/input.h"
#include "app/output/text.h"
#include "lodestone/base/file.h"
#include "lodestone/io/write.h"
#include "lodestone/measure/heat.h"

namespace lodestone::app {

Result<void> check_heat_output(const std::string& output, const std::vector<std::string>& inputs) {
  const Result<void> checked = check_output(output, {inputs.begin(), inputs.end()}, io::Compression::none);
  const std::string extension = extension_of(output);
  if (!checked || extension == ".glb" || extension == ".gltf" || extension == ".ply") return checked;
  return fail(ErrorCode::bad_argument, "--heat writes numbers and colours a vertex, which this format does not keep",
              output, "end its name in .glb, .gltf or .ply");
}

Result<HeatReport> write_heat(const Model& a, const Model& b, const std::string& output, Console& console,
                              const Task& task) {
  measure::HeatOptions options;
  options.linear_colors = extension_of(output) != ".ply";
  const Result<measure::Heat> heat = measure::heat_map(a, b, options, task.part(0.8));
  LODESTONE_TRY(heat);
  const Result<io::WriteReport> written = io::write_model(heat->model, output, {}, task.part(0.2, "writing"));
  LODESTONE_TRY(written);
  console.wrote(output);
  for (const std::string& warning : written->warnings) console.note(fmt::format("{}: {}", output, warning));
  return HeatReport{output, heat->range, heat->largest, drawn_triangles(heat->model)};
}

}  // namespace lodestone::app
