// MTL: the materials of an OBJ.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/core/material.h"

namespace lodestone::io {

/// Appends the materials of an MTL text: Kd, d or Tr, map_Kd (loaded from `folder` or below it), and of the PBR
/// extension Pr and Pm. Everything else is passed over, as is what cannot be understood. Images are loaded once each.
/// A black Kd beside a map_Kd counts as white: exporters write it, and it would make the texture black.
void read_mtl(std::string_view text, const std::filesystem::path& folder, std::vector<Material>& materials,
              std::vector<std::string>& warnings);

}  // namespace lodestone::io
