// Text from outside, made safe for a page.
#pragma once

#include <string>
#include <string_view>

namespace lodestone::report {

/// For between tags and for quoted attributes: & < > " ' become references, control characters spaces, and bytes that
/// are not UTF-8 the replacement character.
std::string escaped(std::string_view text);

}  // namespace lodestone::report
