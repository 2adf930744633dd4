// Decoding images: PNG, JPEG and WebP to pixels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/material.h"
#include "lodestone/core/model.h"
#include "lodestone/core/pixels.h"

namespace lodestone::io {

/// Width times height that an image may claim (16384 squared, 1 GiB decoded): a few bytes can claim any size, so it is
/// checked before memory is asked for.
inline constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 28;

/// Decodes by content, whatever the name and the MIME type say. Deeper channels are cut to 8 bits, grey and palettes
/// become RGB, missing alpha is 255. Errors: empty (no bytes: the file was missing), bad_format (damaged, cut off, no
/// image, or more than `most_pixels`), unsupported (a kind of image that we don't decode).
Result<Pixels> decode_image(const Image& image, std::uint64_t most_pixels = kMostPixels);

/// Decodes the base colour textures of all materials, each image once. A texture that can't be decoded stays null and
/// is told in `warnings`; one that was missing was told by the reader. Errors: cancelled.
Result<void> decode_base_colors(Model& model, std::vector<std::string>& warnings, Task task = {});

}  // namespace lodestone::io
