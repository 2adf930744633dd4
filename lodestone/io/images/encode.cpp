#include "lodestone/io/images/encode.h"

#include <fmt/format.h>

#include <span>

#include "lodestone/base/file.h"
#include "lodestone/base/text.h"
#include "lodestone/core/validate.h"
#include "lodestone/io/images/codecs_detail.h"
#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

namespace {

Result<void> check(const Pixels& pixels) {
  if (pixels.width == 0 || pixels.height == 0) return fail(ErrorCode::bad_argument, "the picture has no pixels");
  return validate(pixels);
}

}  // namespace

bool has_alpha(const Pixels& pixels) {
  for (std::size_t i = 3; i < pixels.rgba.size(); i += 4) {
    if (pixels.rgba[i] != 255) return true;
  }
  return false;
}

std::vector<std::uint8_t> without_alpha(const Pixels& pixels) {
  std::vector<std::uint8_t> rgb(pixels.rgba.size() / 4 * 3);
  for (std::size_t i = 0, o = 0; o < rgb.size(); i += 4, o += 3) {
    for (std::size_t k = 0; k < 3; ++k) rgb[o + k] = pixels.rgba[i + k];
  }
  return rgb;
}

bool is_picture_extension(std::string_view extension) {
  const std::string lower = lower_case(extension);
  return lower == ".png" || lower == ".webp";
}

Result<std::uint64_t> write_picture(const Pixels& pixels, const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  if (!is_picture_extension(extension)) {
    return fail(ErrorCode::bad_argument, fmt::format("'{}' is no format of pictures that we write", extension),
                path.string(), "end it in .png or .webp");
  }
  LODESTONE_TRY(check(pixels));
  const Result<std::string> encoded =
      extension == ".png" ? encode_png(pixels, path.string()) : encode_webp(pixels, path.string());
  LODESTONE_TRY(encoded);
  Result<OutputFile> file = OutputFile::create(path);
  LODESTONE_TRY(file);
  file->write(std::string_view(*encoded));
  const std::uint64_t bytes = file->size();
  LODESTONE_TRY(file->commit());
  return bytes;
}

Result<std::shared_ptr<const Image>> png_image(const Pixels& pixels, std::string name) {
  LODESTONE_TRY(check(pixels));
  const Result<std::string> encoded = encode_png(pixels, name);
  LODESTONE_TRY(encoded);
  auto image = std::make_shared<Image>();
  image->name = name + ".png";
  image->mime = "image/png";
  const auto bytes = std::as_bytes(std::span(*encoded));
  image->encoded.assign(bytes.begin(), bytes.end());
  return std::shared_ptr<const Image>(std::move(image));
}

}  // namespace lodestone::io
