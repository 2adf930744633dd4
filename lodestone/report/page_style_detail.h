// How the report looks.
#pragma once

#include <string_view>

namespace lodestone::report::detail {

/// The page's style sheet.
extern const std::string_view kPageStyle;

}  // namespace lodestone::report::detail
