#include "lodestone/io/write_detail.h"

#include <fmt/format.h>

#include <iterator>

#include "lodestone/core/validate.h"

namespace lodestone::io {

Result<void> check_drawn(const Model& model, const std::filesystem::path& path, const Task& task) {
  LODESTONE_TRY(validate(model, task));
  if (drawn_triangles(model) > 0) return {};
  return fail(ErrorCode::empty, "there is nothing to write: the model draws no triangle", path.string());
}

WriteReport single_file_report(const std::filesystem::path& path, std::uint64_t bytes,
                               std::vector<std::string> warnings) {
  WriteReport report;
  report.files = {path};
  report.level_bytes = {bytes};
  report.total_bytes = bytes;
  report.warnings = std::move(warnings);
  return report;
}

void warn_of_losses(const Mesh& mesh, const char* format, std::vector<std::string>& warnings) {
  if (mesh.attributes.empty()) return;
  std::vector<std::string> names;
  for (const AttributeStream& stream : mesh.attributes) names.push_back(stream.name);
  warnings.push_back(fmt::format("{} holds no attributes; left out: {}", format, fmt::join(names, ", ")));
}

void append_number(std::string& out, float value) { fmt::format_to(std::back_inserter(out), "{}", value); }
void append_number(std::string& out, double value) { fmt::format_to(std::back_inserter(out), "{}", value); }

}  // namespace lodestone::io
