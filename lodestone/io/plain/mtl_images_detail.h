// Images that the MTLs of a model name.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/core/material.h"
#include "lodestone/io/near_file_detail.h"

namespace lodestone::io {

/// Finds and loads each image once, whatever it is called, and no more than 4,096 names: a damaged file may hold any
/// number.
class MtlImages {
 public:
  explicit MtlImages(const std::filesystem::path& folder) : files_(folder) {}

  /// See NearFiles::find().
  std::optional<std::filesystem::path> find(const std::filesystem::path& from, std::string_view name) {
    return files_.find(from, name);
  }

  /// An image that an MTL in the folder `from` names; without bytes, and with a warning, where it is missing. Nothing
  /// for an empty name, and beyond the last name that is looked for.
  std::shared_ptr<const Image> load(const std::filesystem::path& from, std::string_view name,
                                    std::vector<std::string>& warnings);

  /// Whether a pixel of it is not opaque. Decodes it, once.
  bool is_transparent(const std::shared_ptr<const Image>& image);

  /// Tells what was left out because there was too much of it.
  void tell(std::vector<std::string>& warnings) const;

 private:
  std::shared_ptr<const Image> load_file(const std::filesystem::path& path, std::string_view name,
                                         std::vector<std::string>& warnings);

  NearFiles files_;
  std::map<std::string, std::shared_ptr<const Image>> by_name_;             // with `from` before it
  std::map<std::filesystem::path, std::shared_ptr<const Image>> by_path_;   // found ones
  std::multimap<std::string, std::shared_ptr<const Image>> by_short_name_;  // and without their folders
  std::map<const Image*, bool> transparent_;
  std::size_t left_out_ = 0;
};

}  // namespace lodestone::io
