// "Did you mean": the word that somebody had in mind, if one is near enough to be it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lodestone::app {

/// The candidate that `word` is a slip of: at most a third of its letters changed, left out, added or swapped with
/// their neighbour, or all but its first three letters left out. Empty when none is that near. Dashes in front don't
/// count.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// As nearest(), but a verb or option that other programs have under another name is known as well: "decimate" is
/// simplify, "--faces" is --triangles. Only what stands in `candidates` is ever named.
std::string meant(std::string_view word, const std::vector<std::string>& candidates);

/// ", did you mean X?" for what meant() finds, empty for none.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace lodestone::app
