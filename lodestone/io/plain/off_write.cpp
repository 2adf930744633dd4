#include "lodestone/io/plain/off_write.h"

#include <fmt/format.h>

#include "lodestone/base/file.h"
#include "lodestone/core/flatten.h"
#include "lodestone/io/write_detail.h"

namespace lodestone::io {

Result<WriteReport> write_off(const Model& model, const std::filesystem::path& path, Task task) {
  LODESTONE_TRY(check_drawn(model, path, task));
  std::vector<std::string> warnings;
  const Mesh mesh = flatten_to_mesh(model, warnings);
  warn_of_losses(mesh, "OFF", warnings);
  Result<OutputFile> file = OutputFile::create(path);
  LODESTONE_TRY(file);
  file->write(fmt::format("OFF\n{} {} 0\n", mesh.vertex_count(), mesh.triangles.size()));
  std::string line;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    if (v % 65536 == 0 && (task.cancelled() || file->failed())) break;
    line.clear();
    for (std::size_t k = 0; k < 3; ++k) {
      if (mesh.offset == Vec3d{}) {
        append_number(line, mesh.positions[v][k]);
      } else {
        append_number(line, mesh.position(v)[k]);
      }
      line += k < 2 ? ' ' : '\n';
    }
    file->write(line);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (t % 65536 == 0 && (task.cancelled() || file->failed())) break;
    const Triangle v = mesh.vertices_of(t);
    file->write(fmt::format("3 {} {} {}\n", v[0], v[1], v[2]));
  }
  if (task.cancelled()) return cancelled_error("writing");
  LODESTONE_TRY(file->commit());
  return single_file_report(path, file->size(), std::move(warnings));
}

}  // namespace lodestone::io
