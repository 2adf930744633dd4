// MTL: the materials of an OBJ.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/core/material.h"

namespace lodestone::io {

/// Appends the materials of an MTL text: Kd, d or Tr, map_Kd (loaded from `folder` or below it), and of the PBR
/// extension Pr, Pm and norm. Images are loaded once each. A black Kd beside a map_Kd counts as white: exporters write
/// it, and it would make the texture black. Everything else is passed over; its kinds ("Ks", "map_Bump", "map_Kd -s")
/// are appended to `left_out`, each once in any case, "others" in place of those beyond the first dozen.
void read_mtl(std::string_view text, const std::filesystem::path& folder, std::vector<Material>& materials,
              std::vector<std::string>& left_out, std::vector<std::string>& warnings);

/// The files of a material's textures, empty where there is none.
struct MtlTextures {
  std::string base_color, normal;
};

/// The materials as an MTL text, with all that read_mtl() takes. Each is called names[i] and has textures[i].
std::string mtl_text(std::span<const Material> materials, std::span<const std::string> names,
                     std::span<const MtlTextures> textures);

}  // namespace lodestone::io
