// Image files that a model names: found in the model's own folder, loaded undecoded.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/core/material.h"

namespace lodestone::io {

/// "image/png", "image/jpeg", … by the first bytes; empty if they are no image that we know.
std::string image_mime(std::span<const std::byte> encoded);
/// ".png", ".jpg", …; empty for an unknown type.
std::string_view image_extension(std::string_view mime);

/// The place of a file that a model in `folder` names ("textures\\a.png" too). Nothing if the name is absolute or
/// climbs out of the folder.
std::optional<std::filesystem::path> path_inside(const std::filesystem::path& folder, std::string_view name);

/// Loads an image that a model names. Where its path leads nowhere or out of the folder, the bare file name is tried in
/// the folder, as models often carry the paths of the machine that they come from. Missing: an Image without bytes, and
/// a warning.
std::shared_ptr<const Image> load_image_near(const std::filesystem::path& folder, std::string_view name,
                                             std::vector<std::string>& warnings);

}  // namespace lodestone::io
