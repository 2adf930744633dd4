// Words.
#pragma once

#include <string>
#include <string_view>

namespace lodestone {

/// ASCII letters in lower case; all else stays. For endings of file names and key words.
std::string lower_case(std::string_view text);

}  // namespace lodestone
