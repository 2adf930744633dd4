#include "lodestone/core/level.h"

namespace lodestone {

const char* to_string(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::estimated:
      return "estimated";
    case ErrorKind::measured:
      return "measured";
    case ErrorKind::bounded:
      return "bounded";
  }
  return "";
}

void share_materials(Ladder& ladder) {
  std::vector<Material>& all = ladder.original.materials;
  for (std::size_t i = 1; i < ladder.levels.size(); ++i) {
    Model& model = ladder.levels[i].model;
    if (model.materials.empty()) continue;
    const auto first = static_cast<std::uint32_t>(all.size());
    all.insert(all.end(), model.materials.begin(), model.materials.end());
    for (Mesh& mesh : model.meshes) {
      for (FaceGroup& group : mesh.groups) group.material += group.material == kNone ? 0 : first;
      if (model.uv_origin_top == ladder.original.uv_origin_top) continue;
      for (AttributeStream& stream : mesh.attributes) {
        if (stream.semantic != Semantic::uv) continue;
        auto& uv = std::get<std::vector<float>>(stream.values);
        for (std::size_t k = 1; k < uv.size(); k += stream.components) uv[k] = 1 - uv[k];
      }
    }
    model.uv_origin_top = ladder.original.uv_origin_top;
  }
  for (std::size_t i = 1; i < ladder.levels.size(); ++i) {
    if (!ladder.levels[i].model.materials.empty()) ladder.levels[i].model.materials = all;
  }
}

}  // namespace lodestone
