// Groups and materials of an OBJ: which face group a face belongs to, and what its material is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "lodestone/core/model.h"

namespace lodestone::io {

class ObjMaterials {
 public:
  /// `folder` is where libraries may be; null: they are not looked for.
  explicit ObjMaterials(const std::filesystem::path* folder) : folder_(folder) {}

  /// `o` begins a part, `g` a group in it; without one the part's name is the group's.
  void set_object(std::string_view name);
  void set_name(std::string_view name);
  void set_material(std::string_view name);
  void add_library(std::string_view names);
  /// The face group of the present material and name; a new one at its first use.
  std::uint32_t group();
  void clear() { *this = ObjMaterials(folder_); }

  /// Sets the mesh's groups and the model's materials (those used, in order of first use), from the libraries.
  void fill(Model& model) const;

 private:
  std::vector<Material> load_libraries(std::vector<std::filesystem::path>& files,
                                       std::vector<std::string>& warnings) const;

  const std::filesystem::path* folder_;
  std::vector<std::string> libraries_;  // in order of first mention
  std::set<std::string> seen_libraries_;
  std::vector<std::string> used_;                     // names of materials, in order of first use by usemtl
  std::map<std::string, std::uint32_t> material_at_;  // into used_
  std::uint32_t material_ = kNone;
  std::string object_, name_;
  std::vector<FaceGroup> groups_;
  std::map<std::tuple<std::uint32_t, std::string, std::string>, std::uint32_t> group_at_;
  std::uint32_t group_ = kNone;  // of the present material, object and name, once a face has asked
};

}  // namespace lodestone::io
