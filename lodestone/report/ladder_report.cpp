#include "lodestone/report/ladder_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "lodestone/core/validate.h"

namespace lodestone::report {

namespace {

// Vertices with more than one wedge in the triangles of meshes that are drawn.
std::uint64_t seam_vertices(const Model& model) {
  std::uint64_t count = 0;
  const std::vector<std::uint32_t> drawn = instance_counts(model);
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    const Mesh& mesh = model.meshes[m];
    if (drawn[m] == 0 || mesh.wedge_vertex.empty()) continue;
    std::vector<std::uint32_t> wedges(mesh.vertex_count(), 0);
    for (const std::uint32_t v : mesh.wedge_vertex) ++wedges[v];
    count +=
        static_cast<std::uint64_t>(std::count_if(wedges.begin(), wedges.end(), [](std::uint32_t n) { return n > 1; }));
  }
  return count;
}

}  // namespace

Result<ReportData> ladder_report(const chain::LadderResult& result, const PictureOptions& pictures, Task task) {
  const Ladder& ladder = result.ladder;
  LODESTONE_TRY(validate(ladder, task));
  ReportData data;
  data.diagonal = ladder.levels.front().error.diagonal;
  data.seam_vertices = seam_vertices(ladder.original);
  data.warnings = ladder.original.warnings;
  for (const chain::Shortfall& shortfall : result.shortfalls) {
    data.shortfalls.push_back(fmt::format("Level {}: {}.", shortfall.level, shortfall.reason));
  }
  const Task counting = task.part(0.2);
  for (std::size_t i = 0; i < ladder.levels.size(); ++i) {
    const Result<measure::Shape> shape = measure::shape_of(ladder.model(i), counting);
    LODESTONE_TRY(shape);
    ReportLevel level;
    level.triangles = ladder.levels[i].triangles;
    level.error = ladder.levels[i].error;
    level.shape = *shape;
    if (i < result.images.size()) level.image = result.images[i];
    data.levels.push_back(std::move(level));
  }
  Result<std::vector<LevelPictures>> drawn = draw_levels(ladder, pictures, task.part(0.8));
  LODESTONE_TRY(drawn);
  data.pictures = std::move(*drawn);
  return data;
}

void add_files(ReportData& data, const io::WriteReport& written) {
  for (std::size_t i = 0; i < data.levels.size(); ++i) {
    data.levels[i].bytes = written.level_bytes[i];
    data.levels[i].file = written.files[i].filename().string();
  }
  data.warnings.insert(data.warnings.end(), written.warnings.begin(), written.warnings.end());
}

}  // namespace lodestone::report
