// One function a library; each is defined in the one file that sees its library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/core/pixels.h"

namespace lodestone::io {

Result<Pixels> decode_png(std::span<const std::byte> encoded, const std::string& name, std::uint64_t most_pixels);
Result<Pixels> decode_jpeg(std::span<const std::byte> encoded, const std::string& name, std::uint64_t most_pixels);
Result<Pixels> decode_webp(std::span<const std::byte> encoded, const std::string& name, std::uint64_t most_pixels);

/// With alpha only where some pixel has it. Errors: unsupported (a size that the format can't hold), out_of_memory.
Result<std::string> encode_png(const Pixels& pixels, const std::string& name);
Result<std::string> encode_webp(const Pixels& pixels, const std::string& name);

/// Whether some pixel's alpha is below 255.
bool has_alpha(const Pixels& pixels);
/// Red, green and blue alone.
std::vector<std::uint8_t> without_alpha(const Pixels& pixels);

/// Room for an image of this size. Errors: bad_format (a side is 0, more than `most_pixels`).
Result<Pixels> make_pixels(std::uint64_t width, std::uint64_t height, const std::string& name,
                           std::uint64_t most_pixels);

}  // namespace lodestone::io
