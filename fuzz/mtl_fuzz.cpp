// Any bytes as the MTL of an OBJ: materials that are valid, an MTL of them, and what glTF gets; never a crash, a hang,
// or much memory.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/base/check.h"
#include "lodestone/core/material.h"
#include "lodestone/io/plain/mtl_detail.h"
#include "lodestone/io/plain/mtl_images_detail.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestone;
  io::MtlImages images(std::filesystem::path("fuzz-has-no-such-folder"));
  std::vector<Material> materials;
  std::vector<std::string> warnings;
  io::read_mtl(std::string_view(reinterpret_cast<const char*>(data), size), images, "", materials, warnings);
  std::vector<std::string> names;
  for (const Material& material : materials) {
    names.push_back(material.name);
    std::vector<std::string> left_out;
    const io::MtlLook look = io::look_of(material, left_out);
    for (const float light : look.emissive) LODESTONE_CHECK(light >= 0 && light <= 1, "what glTF may hold");
    for (const float c : material.base_color) LODESTONE_CHECK(c >= 0 && c <= 1, "what glTF may hold");
  }
  const std::string text = io::mtl_text(materials, names, {});
  LODESTONE_CHECK(text.size() <= 64 * (size + 2), "no more comes out than went in");
  return 0;
}
