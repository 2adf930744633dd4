// Names of attributes: which glTF allows, and what those are called that it does not.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/io/gltf/gltf_detail.h"

namespace lodestone::io {

/// True for the names that the format knows, and for one's own with an underscore before them.
bool is_legal_attribute(std::string_view name);

/// All names in a mesh of the document: its primitives' attributes, morph targets and Draco streams.
std::set<std::string> attribute_names(const Json& mesh);

/// The names of `names` that are not legal, and what they are called instead: with underscores before them, as many
/// as it takes to be nobody else's.
std::map<std::string, std::string> legal_names(const std::set<std::string>& names);

/// Gives attributes without underscore one, the same in all primitives and morph targets of a mesh; Draco's stay, as
/// their streams name them, too. Told in `warnings`.
void repair_names(Json& json, std::vector<std::string>& warnings);

}  // namespace lodestone::io
