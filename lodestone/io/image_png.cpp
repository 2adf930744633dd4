// PNG through libpng's simplified interface, which needs no long jumps in our code.
#include <fmt/format.h>
#include <png.h>

#include "lodestone/io/image_codecs_detail.h"

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

}  // namespace lodestone::io
