// Text for a page: made safe, with units.
#pragma once

#include <string>
#include <string_view>

namespace lodestone::report {

/// For between tags and for quoted attributes: & < > " ' become references, control characters spaces, and bytes that
/// are not UTF-8 the replacement character.
std::string escaped(std::string_view text);

/// "error (mm)", or the title alone without a unit. Not escaped.
std::string with_unit(std::string_view title, std::string_view unit);

}  // namespace lodestone::report
