// PNG through libpng's simplified interface, which needs no long jumps in our code.
#include <fmt/format.h>
#include <png.h>

#include "lodestone/io/images/codecs_detail.h"

namespace lodestone::io {

Result<Pixels> decode_png(std::span<const std::byte> encoded, const std::string& name, std::uint64_t most_pixels) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const auto broken = [&] {
    auto error = fail(ErrorCode::bad_format, fmt::format("the PNG can't be decoded: {}", image.message), name);
    png_image_free(&image);
    return error;
  };
  if (png_image_begin_read_from_memory(&image, encoded.data(), encoded.size()) == 0) return broken();
  image.format = PNG_FORMAT_RGBA;
  Result<Pixels> pixels = make_pixels(image.width, image.height, name, most_pixels);
  if (!pixels) {
    png_image_free(&image);
    return pixels;
  }
  if (png_image_finish_read(&image, nullptr, pixels->rgba.data(), 0, nullptr) == 0) return broken();
  png_image_free(&image);
  return pixels;
}

Result<std::string> encode_png(const Pixels& pixels, const std::string& name) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = pixels.width;
  image.height = pixels.height;
  const bool alpha = has_alpha(pixels);
  image.format = alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  const std::vector<std::uint8_t> rgb = alpha ? std::vector<std::uint8_t>() : without_alpha(pixels);
  const std::uint8_t* rows = alpha ? pixels.rgba.data() : rgb.data();
  std::string encoded(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = encoded.size();
  if (png_image_write_to_memory(&image, encoded.data(), &size, 0, rows, 0, nullptr) == 0) {
    auto error = fail(ErrorCode::unsupported, fmt::format("the PNG can't be encoded: {}", image.message), name);
    png_image_free(&image);
    return error;
  }
  encoded.resize(size);
  return encoded;
}

}  // namespace lodestone::io
