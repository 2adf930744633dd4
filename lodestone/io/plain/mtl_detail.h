// MTL: the materials of an OBJ.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/core/material.h"
#include "lodestone/io/images/file_detail.h"

namespace lodestone::io {

class MtlImages;

/// Appends the materials of an MTL text that lies in the folder `from` of the images' root: Kd, d or Tr, map_Kd, and of
/// the PBR extension Pr, Pm and norm. All other lines, and of these the options of maps, are kept verbatim in
/// Material::mtl_lines, textures with their images, up to 256 of a material; comments go. A black Kd beside a map_Kd
/// counts as white: exporters write it, and it would make the texture black. Without Pr the roughness is that of the
/// highlight, see roughness_of_highlight(). A map_d that is the map_Kd makes Material::blend
/// where the image is transparent anywhere.
void read_mtl(std::string_view text, MtlImages& images, const std::filesystem::path& from,
              std::vector<Material>& materials, std::vector<std::string>& warnings);

/// (2 / (Ns + 2))^1/4, the roughness whose GGX highlight is as wide as Blinn and Phong's with exponent Ns; 1 where Ks
/// is black or illum says that there is no highlight. Nothing where the MTL gave no Ns.
std::optional<float> roughness_of_highlight(const Material& material);

/// The materials as an MTL text: what read_mtl() takes, and the kept lines. Each is called names[i]; textures that are
/// not among `textures` are left out. Pr and Pm are left out where Ns says the same.
std::string mtl_text(std::span<const Material> materials, std::span<const std::string> names,
                     std::span<const TextureFile> textures);

/// What glTF holds of the kept lines.
struct MtlLook {
  std::array<float, 3> emissive{0, 0, 0};  ///< Ke, at most 1 each; white for a map_Ke without Ke
  const Image* emissive_texture = nullptr;
  const Image* normal_texture = nullptr;  ///< map_Bump or bump, where the image is a normal map and no height map
  float normal_scale = 1;                 ///< its -bm, or norm's
};

/// The kinds of lines that it does not hold ("Ks", "map_Bump", "map_Kd -s") are appended to `left_out`, each once in
/// any case, "others" in place of those beyond the first dozen. Decodes images that may be normal maps.
MtlLook look_of(const Material& material, std::vector<std::string>& left_out);

}  // namespace lodestone::io
