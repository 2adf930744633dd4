// Any bytes as an image: pixels of the size they claim, or an error; never a crash, a hang, or much memory.
#include <cstddef>
#include <cstdint>
#include <span>

#include "lodestone/base/check.h"
#include "lodestone/io/images/decode.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lodestone::Image image;
  const auto bytes = std::as_bytes(std::span(data, size));
  image.encoded.assign(bytes.begin(), bytes.end());
  const auto pixels = lodestone::io::decode_image(image, std::uint64_t{1} << 20);
  if (pixels) {
    LODESTONE_CHECK(pixels->rgba.size() == std::size_t{4} * pixels->width * pixels->height, "all pixels are there");
  }
  return 0;
}
