// WebP through libwebp.
#include <webp/decode.h>

#include "lodestone/io/image_codecs_detail.h"

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

}  // namespace lodestone::io
