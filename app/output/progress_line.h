// The line of the progress bar, for a width.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace lodestone::app {

/// What is being done, a bar, the share done and the time left, in at most `width` columns. Where room is short the bar
/// goes first, then the title, then the time left; of the label as much stays as there is room for. `title` is what
/// stands before the label ("3 of 20, a.ply"), `left` the time left as text; both may be empty.
std::string progress_line(std::string_view title, std::string_view label, double done, std::string_view left,
                          std::size_t width);

}  // namespace lodestone::app
