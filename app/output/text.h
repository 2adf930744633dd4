// Text for people: names made harmless, widths, numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "lodestone/base/result.h"

namespace lodestone::app {

/// Control characters, direction marks and bytes that are not UTF-8 become \xNN, so a file name can't play with a
/// terminal.
std::string printable(std::string_view text);

/// Columns that UTF-8 text takes, one a code point.
std::size_t width_of(std::string_view text);
/// The first `width` columns.
std::string cut_to_width(std::string_view text, std::size_t width);

std::string seconds_text(double seconds);

/// Breaks at spaces so that no line is wider than `width`; every line but the first begins with `indent` spaces.
std::string wrapped(std::string_view text, std::size_t width, std::size_t indent);

/// "lod: <the error as one line>", printable.
std::string error_text(const Error& error);

}  // namespace lodestone::app
