// Base64 (RFC 4648), as data URIs have it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace lodestone {

/// The bytes, or nothing if a character is not of the alphabet or the length cannot be. Padding may be missing. O(n).
std::optional<std::string> decode_base64(std::string_view text);

/// With padding. O(n).
std::string encode_base64(std::string_view bytes);

}  // namespace lodestone
