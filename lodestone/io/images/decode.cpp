#include "lodestone/io/images/decode.h"

#include <fmt/format.h>

#include "lodestone/io/images/codecs_detail.h"
#include "lodestone/io/images/file_detail.h"
#include "lodestone/io/read_detail.h"

namespace lodestone::io {

Result<Pixels> make_pixels(std::uint64_t width, std::uint64_t height, const std::string& name,
                           std::uint64_t most_pixels) {
  if (width == 0 || height == 0) return fail(ErrorCode::bad_format, "the image has no pixels", name);
  if (width > most_pixels / height) {
    return fail(ErrorCode::bad_format,
                fmt::format("the image claims {} x {} pixels, the limit is {}", width, height, count_text(most_pixels)),
                name, "make it smaller");
  }
  Pixels pixels;
  pixels.width = static_cast<std::uint32_t>(width);
  pixels.height = static_cast<std::uint32_t>(height);
  pixels.rgba.resize(static_cast<std::size_t>(width * height) * 4);
  return pixels;
}

Result<Pixels> decode_image(const Image& image, std::uint64_t most_pixels) {
  const std::string name = image.name.empty() ? "image" : image.name;
  if (image.encoded.empty()) return fail(ErrorCode::empty, "the image has no bytes; its file was missing", name);
  const std::string mime = image_mime(image.encoded);
  if (mime == "image/png") return decode_png(image.encoded, name, most_pixels);
  if (mime == "image/jpeg") return decode_jpeg(image.encoded, name, most_pixels);
  if (mime == "image/webp") return decode_webp(image.encoded, name, most_pixels);
  if (mime.empty()) return fail(ErrorCode::bad_format, "is not an image of a known type", name);
  return fail(ErrorCode::unsupported, fmt::format("images of type {} can't be decoded", mime), name,
              "convert it to PNG, JPEG or WebP");
}

Result<void> decode_base_colors(Model& model, std::vector<std::string>& warnings, Task task) {
  // A glTF reader gives each material an image of its own, be it the same: compare bytes.
  std::vector<std::size_t> first;  // materials whose image is the first of its kind
  const auto same = [&](const Material& m, const Material& other) {
    return m.base_color_texture == other.base_color_texture ||
           m.base_color_texture->encoded == other.base_color_texture->encoded;
  };
  for (std::size_t m = 0; m < model.materials.size(); ++m) {
    Material& material = model.materials[m];
    if (material.base_color_texture == nullptr || material.base_color_texture->encoded.empty()) continue;
    if (task.cancelled()) return cancelled_error("decoding images");
    bool known = false;
    for (const std::size_t other : first) {
      if (!same(material, model.materials[other])) continue;
      material.base_color_pixels = model.materials[other].base_color_pixels;
      known = true;
      break;
    }
    if (known) continue;
    first.push_back(m);
    Result<Pixels> pixels = decode_image(*material.base_color_texture);
    if (pixels) {
      material.base_color_pixels = std::make_shared<const Pixels>(std::move(*pixels));
    } else {
      warnings.push_back(pixels.error().line());
    }
  }
  return {};
}

}  // namespace lodestone::io
