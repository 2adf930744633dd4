// Words of an MTL's lines.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "lodestone/base/text.h"
#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

/// Up to `count` numbers off the front of `rest`; returns how many there were.
inline std::size_t take_numbers(std::string_view& rest, float* into, std::size_t count) {
  std::size_t taken = 0;
  while (taken < count) {
    std::string_view ahead = rest;
    float value = 0;
    if (!parse_number(next_word(ahead), value)) break;
    into[taken++] = value;
    rest = ahead;
  }
  return taken;
}

/// Takes an option of a map line ("-s 2 2 1") off the front of `rest`; it, or nothing where none is there.
inline std::string_view take_option(std::string_view& rest) {
  std::string_view ahead = trimmed(rest);
  const std::string_view begin = ahead;
  if (!ahead.starts_with('-')) return {};
  const std::string_view option = next_word(ahead);
  float ignored[3];
  if (option == "-s" || option == "-o" || option == "-t") {
    take_numbers(ahead, ignored, 3);
  } else if (option == "-mm") {
    take_numbers(ahead, ignored, 2);
  } else if (option == "-bm" || option == "-boost" || option == "-texres") {
    take_numbers(ahead, ignored, 1);
  } else if (option == "-blendu" || option == "-blendv" || option == "-cc" || option == "-clamp" ||
             option == "-imfchan" || option == "-type") {
    next_word(ahead);
  } else {
    return {};  // a name that begins with '-'
  }
  rest = ahead;
  return trimmed(begin.substr(0, begin.size() - ahead.size()));
}

/// The first word of a line in small letters.
inline std::string key_of(std::string_view line) { return lower_case(next_word(line)); }

/// True for the keys of lines that name an image.
inline bool is_map_key(std::string_view key) {
  return (key.starts_with("map_") && key != "map_aat") || key == "norm" || key == "bump" || key == "disp" ||
         key == "decal" || key == "refl";
}

inline bool is_bump_key(std::string_view key) { return key == "map_bump" || key == "bump"; }

}  // namespace lodestone::io
