// What the library calls its settings, in the words of the command line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lodestone/base/result.h"

namespace lodestone::app {

/// Messages of the library name its settings in backquotes, as the options structs do: "raise `resolution`". Here they
/// become options: "raise --resolution". What is no option stays as it is.
std::string with_options(std::string_view text);
std::vector<std::string> with_options(std::vector<std::string> texts);
Error with_options(Error error);  ///< its place, which may be a file's name, stays as it is

}  // namespace lodestone::app
