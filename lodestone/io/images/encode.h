// Writing pictures: PNG and WebP.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "lodestone/base/result.h"
#include "lodestone/core/material.h"
#include "lodestone/core/pixels.h"

namespace lodestone::io {

/// True for the endings that write_picture() knows, with the dot, any case: .png, .webp.
bool is_picture_extension(std::string_view extension);

/// Encodes by the name's ending and puts the file under its name whole or not at all; returns its bytes. Pictures
/// without alpha are written without. Errors: bad_argument (another ending, no pixels), unsupported (larger than the
/// format allows), cannot_write.
Result<std::uint64_t> write_picture(const Pixels& pixels, const std::filesystem::path& path);

/// A PNG as a material's texture: `name` without ending. Errors: bad_argument (no pixels), unsupported.
Result<std::shared_ptr<const Image>> png_image(const Pixels& pixels, std::string name);

/// A small WebP for looking at, not lossless, without alpha; `quality` 0 to 100. Errors: bad_argument (no pixels, more
/// than the format allows), out_of_memory.
Result<std::string> preview_webp(const Pixels& pixels, int quality = 86);

}  // namespace lodestone::io
