#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "lodestone/base/base64.h"
#include "lodestone/io/gltf/uri_detail.h"

namespace lodestone::io {

namespace {

constexpr std::size_t kShown = 60;  // characters of a URI that an error shows

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool is_alpha(char c) { return lower(c) >= 'a' && lower(c) <= 'z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

int hex_value(char c) {
  if (is_digit(c)) return c - '0';
  const char l = lower(c);
  return l >= 'a' && l <= 'f' ? l - 'a' + 10 : -1;
}

std::string shown(std::string_view uri) {
  return std::string(uri.substr(0, kShown)) + (uri.size() > kShown ? "..." : "");
}

// A percent sign that no two hex digits follow stays as it is: exporters that forget to encode write such names.
std::string percent_decode(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && hex_value(text[i + 1]) >= 0 && hex_value(text[i + 2]) >= 0) {
      out.push_back(static_cast<char>(hex_value(text[i + 1]) * 16 + hex_value(text[i + 2])));
      i += 2;
    } else {
      out.push_back(text[i]);
    }
  }
  return out;
}

// RFC 3986, 3.1; a drive letter ("C:") looks like one and is refused with the rest.
bool has_scheme(std::string_view uri) {
  if (uri.empty() || !is_alpha(uri[0])) return false;
  for (const char c : uri) {
    if (c == ':') return true;
    if (!is_alpha(c) && !is_digit(c) && c != '+' && c != '-' && c != '.') return false;
  }
  return false;
}

bool climbs_out(std::string_view path) {
  int depth = 0;
  while (!path.empty()) {
    const std::size_t slash = std::min(path.find('/'), path.size());
    const std::string_view part = path.substr(0, slash);
    path.remove_prefix(std::min(path.size(), slash + 1));
    if (part == "..") {
      if (--depth < 0) return true;
    } else if (!part.empty() && part != ".") {
      ++depth;
    }
  }
  return false;
}

}  // namespace

bool is_data_uri(std::string_view uri) {
  constexpr std::string_view scheme = "data:";
  return uri.size() >= scheme.size() &&
         std::equal(scheme.begin(), scheme.end(), uri.begin(), [](char a, char b) { return a == lower(b); });
}

Result<DataUri> decode_data_uri(std::string_view uri, const std::string& where) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) {
    return fail(ErrorCode::bad_format, "a data URI without a comma: '" + shown(uri) + "'", where);
  }
  DataUri out;
  std::string_view head = uri.substr(5, comma - 5);
  const std::size_t semicolon = head.find(';');
  for (const char c : head.substr(0, semicolon)) out.mime.push_back(lower(c));
  constexpr std::string_view base64 = ";base64";
  const bool is_base64 =
      head.size() >= base64.size() &&
      std::equal(base64.begin(), base64.end(), head.end() - static_cast<std::ptrdiff_t>(base64.size()),
                 [](char a, char b) { return a == lower(b); });
  if (!is_base64) {
    out.bytes = percent_decode(uri.substr(comma + 1));
    return out;
  }
  std::optional<std::string> bytes = decode_base64(uri.substr(comma + 1));
  if (!bytes) return fail(ErrorCode::bad_format, "the data URI is not valid base64", where, "is the file cut off?");
  out.bytes = std::move(*bytes);
  return out;
}

Result<std::filesystem::path> resolve_uri(const std::filesystem::path& folder, std::string_view uri,
                                          const std::string& where) {
  const auto refuse = [&](std::string_view why) {
    return fail(ErrorCode::bad_format, fmt::format("the URI '{}' {}", shown(uri), why), where,
                "put the file beside the model and name it by a relative path");
  };
  if (has_scheme(uri)) return refuse("has a scheme; only data: and relative paths are read");
  std::string path = percent_decode(uri);
  std::replace(path.begin(), path.end(), '\\', '/');
  if (path.empty()) return refuse("is empty");
  if (path.find('\0') != std::string::npos) return refuse("holds a zero byte");
  if (path.front() == '/') return refuse("is absolute");
  if (climbs_out(path)) return refuse("climbs out of the model's folder");
  return folder / std::filesystem::path(path);
}

std::string encode_uri(std::string_view name) {
  std::string out;
  for (const char c : name) {
    if (is_alpha(c) || is_digit(c) || c == '-' || c == '.' || c == '_' || c == '~') {
      out.push_back(c);
    } else {
      out += fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    }
  }
  return out;
}

}  // namespace lodestone::io
