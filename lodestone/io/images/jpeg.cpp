// JPEG through TurboJPEG, which needs no long jumps in our code.
#include <fmt/format.h>
#include <turbojpeg.h>

#include <memory>

#include "lodestone/io/images/codecs_detail.h"

namespace lodestone::io {

Result<Pixels> decode_jpeg(std::span<const std::byte> encoded, const std::string& name, std::uint64_t most_pixels) {
  const std::unique_ptr<void, int (*)(tjhandle)> decoder(tjInitDecompress(), tjDestroy);
  if (decoder == nullptr) return fail(ErrorCode::out_of_memory, "the JPEG decoder can't be started", name);
  // What a viewer would show in spite of a warning (grey for what is cut off) is not to be measured: an error as well.
  const auto broken = [&] {
    return fail(ErrorCode::bad_format, fmt::format("the JPEG can't be decoded: {}", tjGetErrorStr2(decoder.get())),
                name);
  };
  const auto* bytes = reinterpret_cast<const unsigned char*>(encoded.data());
  const auto size = static_cast<unsigned long>(encoded.size());
  int width = 0, height = 0, sampling = 0, space = 0;
  if (tjDecompressHeader3(decoder.get(), bytes, size, &width, &height, &sampling, &space) != 0) return broken();
  Result<Pixels> pixels = make_pixels(width > 0 ? static_cast<std::uint64_t>(width) : 0,
                                      height > 0 ? static_cast<std::uint64_t>(height) : 0, name, most_pixels);
  if (!pixels) return pixels;
  // A progressive file may hold thousands of scans of a large image in a few bytes, hence the limit on them.
  constexpr int kFlags = TJFLAG_LIMITSCANS | TJFLAG_ACCURATEDCT;
  if (tjDecompress2(decoder.get(), bytes, size, pixels->rgba.data(), width, 0, height, TJPF_RGBA, kFlags) != 0) {
    return broken();
  }
  return pixels;
}

}  // namespace lodestone::io
