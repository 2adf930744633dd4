// Image files that a model names: found in the model's own folder, loaded undecoded, and written beside it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/base/file.h"
#include "lodestone/core/material.h"

namespace lodestone::io {

/// "image/png", "image/jpeg", … by the first bytes; empty if they are no image that we know.
std::string image_mime(std::span<const std::byte> encoded);
/// ".png", ".jpg", …; empty for an unknown type.
std::string_view image_extension(std::string_view mime);

/// Loads the image in `path`, which a model calls `name`. Missing, not to be read or of no known type: an Image without
/// bytes, and a warning.
std::shared_ptr<const Image> load_image(const std::optional<std::filesystem::path>& path, std::string_view name,
                                        std::vector<std::string>& warnings);

/// Loads an image that a model in `folder` names; see NearFiles. Errors as above.
std::shared_ptr<const Image> load_image_near(const std::filesystem::path& folder, std::string_view name,
                                             std::vector<std::string>& warnings);

/// An image that is written beside a model, and its file name there.
struct TextureFile {
  const Image* image = nullptr;
  std::string name;
};

/// The base colour textures of the materials, with `all` their normal textures and those of MTL lines as well, each
/// image once, in order of first use; those without bytes are left out.
/// Their names are the images' own without folders, safe to stand in a line of text, all different and different from
/// `model` and its .mtl.
std::vector<TextureFile> texture_files(std::span<const Material> materials, const std::filesystem::path& model,
                                       bool all = false);
/// The name of the image's file; empty if it has none.
std::string_view texture_name(std::span<const TextureFile> files, const Image* image);
/// Opens the file beside `model` and writes the image; the caller commits. Errors: cannot_write.
Result<OutputFile> write_texture(const TextureFile& texture, const std::filesystem::path& model);

}  // namespace lodestone::io
