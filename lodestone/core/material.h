// Materials and images, as far as our own writers, the renderer and the baker need them. A glTF document keeps its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace lodestone {

/// An image file as found, not decoded.
struct Image {
  std::string name;                ///< file name as the model said
  std::string mime;                ///< "image/png", "image/jpeg", …
  std::vector<std::byte> encoded;  ///< the file's bytes; empty when it was missing (then a warning was given)
};

struct Material {
  std::string name;
  std::array<float, 4> base_color{1, 1, 1, 1};  ///< linear RGBA factor
  float metallic = 0;
  float roughness = 1;
  std::shared_ptr<const Image> base_color_texture;  ///< may be null
  bool double_sided = false;
};

}  // namespace lodestone
