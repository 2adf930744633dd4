// WebP through libwebp.
#include <fmt/format.h>
#include <webp/decode.h>
#include <webp/encode.h>

#include "lodestone/io/images/codecs_detail.h"
#include "lodestone/io/images/encode.h"

namespace lodestone::io {

Result<Pixels> decode_webp(std::span<const std::byte> encoded, const std::string& name, std::uint64_t most_pixels) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(encoded.data());
  WebPBitstreamFeatures features{};
  const auto broken = [&] { return fail(ErrorCode::bad_format, "the WebP is damaged or cut off", name); };
  if (WebPGetFeatures(bytes, encoded.size(), &features) != VP8_STATUS_OK) return broken();
  if (features.has_animation != 0) {
    return fail(ErrorCode::unsupported, "an animated WebP is no texture", name, "keep one of its pictures");
  }
  Result<Pixels> pixels =
      make_pixels(features.width > 0 ? static_cast<std::uint64_t>(features.width) : 0,
                  features.height > 0 ? static_cast<std::uint64_t>(features.height) : 0, name, most_pixels);
  if (!pixels) return pixels;
  if (WebPDecodeRGBAInto(bytes, encoded.size(), pixels->rgba.data(), pixels->rgba.size(), features.width * 4) ==
      nullptr) {
    return broken();
  }
  return pixels;
}

Result<std::string> encode_webp(const Pixels& pixels, const std::string& name) {
  if (pixels.width > WEBP_MAX_DIMENSION || pixels.height > WEBP_MAX_DIMENSION) {
    return fail(ErrorCode::unsupported,
                fmt::format("WebP holds at most {0} x {0} pixels, the picture has {1} x {2}", WEBP_MAX_DIMENSION,
                            pixels.width, pixels.height),
                name, "write a PNG");
  }
  const int width = static_cast<int>(pixels.width), height = static_cast<int>(pixels.height);
  std::uint8_t* bytes = nullptr;
  std::size_t size = 0;
  if (has_alpha(pixels)) {
    size = WebPEncodeLosslessRGBA(pixels.rgba.data(), width, height, width * 4, &bytes);
  } else {
    const std::vector<std::uint8_t> rgb = without_alpha(pixels);
    size = WebPEncodeLosslessRGB(rgb.data(), width, height, width * 3, &bytes);
  }
  if (size == 0) return fail(ErrorCode::out_of_memory, "the WebP can't be encoded", name, "write a PNG");
  std::string encoded(reinterpret_cast<const char*>(bytes), size);
  WebPFree(bytes);
  return encoded;
}

Result<std::string> preview_webp(const Pixels& pixels, int quality) {
  if (pixels.width == 0 || pixels.height == 0 || pixels.width > WEBP_MAX_DIMENSION ||
      pixels.height > WEBP_MAX_DIMENSION) {
    return fail(ErrorCode::bad_argument, fmt::format("a WebP can't have {} x {} pixels", pixels.width, pixels.height));
  }
  const int width = static_cast<int>(pixels.width), height = static_cast<int>(pixels.height);
  const std::vector<std::uint8_t> rgb = without_alpha(pixels);
  std::uint8_t* bytes = nullptr;
  const std::size_t size = WebPEncodeRGB(rgb.data(), width, height, width * 3, static_cast<float>(quality), &bytes);
  if (size == 0) return fail(ErrorCode::out_of_memory, "the WebP can't be encoded");
  std::string encoded(reinterpret_cast<const char*>(bytes), size);
  WebPFree(bytes);
  return encoded;
}

}  // namespace lodestone::io
