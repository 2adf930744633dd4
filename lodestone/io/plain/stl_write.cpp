#include "lodestone/io/plain/stl_write.h"

#include <cstring>

#include "lodestone/base/file.h"
#include "lodestone/core/flatten.h"
#include "lodestone/io/write_detail.h"
#include "lodestone/math/triangle.h"

namespace lodestone::io {

Result<WriteReport> write_stl(const Model& model, const std::filesystem::path& path, Task task) {
  LODESTONE_TRY(check_drawn(model, path, task));
  std::vector<std::string> warnings;
  const Mesh mesh = flatten_to_mesh(model, warnings);
  warn_of_losses(mesh, "STL", warnings);
  if (mesh.offset != Vec3d{}) warnings.emplace_back("STL holds floats: coordinates far from the origin lose precision");
  Result<OutputFile> file = OutputFile::create(path);
  LODESTONE_TRY(file);
  std::string head(80, ' ');
  std::memcpy(head.data(), "Lodestone", 9);
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  head.append(reinterpret_cast<const char*>(&count), 4);
  file->write(head);
  std::string record(50, '\0');
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (t % 65536 == 0 && (task.cancelled() || file->failed())) break;
    const Triangle v = mesh.vertices_of(t);
    const Vec3d p[3] = {mesh.position(v[0]), mesh.position(v[1]), mesh.position(v[2])};
    Vec3f floats[4] = {to_float(normalized(scaled_normal(p[0], p[1], p[2]))), to_float(p[0]), to_float(p[1]),
                       to_float(p[2])};
    for (Vec3f& f : floats) f += Vec3f{};  // -0 becomes 0
    std::memcpy(record.data(), floats, 48);
    file->write(record);
  }
  if (task.cancelled()) return cancelled_error("writing");
  LODESTONE_TRY(file->commit());
  return single_file_report(path, file->size(), std::move(warnings));
}

}  // namespace lodestone::io
