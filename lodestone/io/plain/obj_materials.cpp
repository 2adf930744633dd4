#include <fmt/format.h>

#include <map>
#include <set>

#include "lodestone/base/file.h"
#include "lodestone/io/plain/mtl_detail.h"
#include "lodestone/io/plain/mtl_images_detail.h"
#include "lodestone/io/plain/obj_materials_detail.h"
#include "lodestone/io/read_detail.h"
#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

void ObjMaterials::set_object(std::string_view name) {
  object_ = name;
  set_name(name);
}

void ObjMaterials::set_name(std::string_view name) {
  name_ = name;
  group_ = kNone;
}

void ObjMaterials::set_material(std::string_view name) {
  group_ = kNone;
  material_ = kNone;
  if (name.empty()) return;
  const auto [at, is_new] = material_at_.try_emplace(std::string(name), static_cast<std::uint32_t>(used_.size()));
  if (is_new) used_.emplace_back(name);
  material_ = at->second;
}

void ObjMaterials::add_library(std::string_view names) {
  if (!names.empty() && seen_libraries_.emplace(names).second) libraries_.emplace_back(names);
}

std::uint32_t ObjMaterials::group() {
  if (group_ != kNone) return group_;
  const auto [at, is_new] =
      group_at_.try_emplace(std::make_tuple(material_, object_, name_), static_cast<std::uint32_t>(groups_.size()));
  if (is_new) groups_.push_back({material_, name_, object_});
  return group_ = at->second;
}

// A library line names one file, whose name may hold blanks, or several.
std::vector<Material> ObjMaterials::load_libraries(std::vector<std::filesystem::path>& files,
                                                   std::vector<std::string>& warnings) const {
  if (folder_ == nullptr) return {};
  std::vector<Material> materials;
  MtlImages images(*folder_);
  std::set<std::filesystem::path> known;
  const auto load = [&](std::string_view name) {
    const std::optional<std::filesystem::path> path = images.find({}, name);
    if (!path) return false;
    if (!known.insert(*path).second) return true;
    const Result<std::string> text = read_file(*path);
    if (!text) return false;
    files.push_back(*path);
    read_mtl(*text, images, path->parent_path().lexically_relative(*folder_), materials, warnings);
    return true;
  };
  std::size_t missing = 0;
  std::string first_missing;
  for (const std::string& names : libraries_) {
    if (load(names)) continue;
    std::string_view rest = names;
    for (std::string_view name = next_word(rest); !name.empty(); name = next_word(rest)) {
      if (load(name)) continue;
      if (missing++ == 0) first_missing = name;
    }
  }
  if (missing > 0) {
    warnings.push_back(fmt::format("{} not found in the OBJ's folder: '{}'{}",
                                   counted(missing, "material library was", "material libraries were"), first_missing,
                                   missing > 1 ? " and others" : ""));
  }
  images.tell(warnings);
  return materials;
}

void ObjMaterials::fill(Model& model) const {
  if (!used_.empty()) {
    const std::vector<Material> known = load_libraries(model.files, model.warnings);
    std::map<std::string_view, const Material*> by_name;  // the first of a name counts
    for (const Material& material : known) by_name.try_emplace(material.name, &material);
    std::size_t unknown = 0;
    for (const std::string& name : used_) {
      const auto at = by_name.find(name);
      Material material;
      material.name = name;
      if (at != by_name.end()) material = *at->second;
      unknown += at == by_name.end() ? 1 : 0;
      model.materials.push_back(std::move(material));
    }
    if (unknown > 0) {
      model.warnings.push_back(
          fmt::format("{} of {} materials are defined nowhere: taken as white", unknown, used_.size()));
    }
  }
  const bool nameless =
      groups_.size() <= 1 && (groups_.empty() || (groups_[0].material == kNone && groups_[0].name.empty()));
  if (!nameless) model.meshes[0].groups = groups_;
}

}  // namespace lodestone::io
