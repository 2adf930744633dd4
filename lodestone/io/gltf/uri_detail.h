// URIs as glTF uses them: data URIs, and relative names of files in the model's own folder or below it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lodestone/base/result.h"

namespace lodestone::io {

/// "data:..." in any case.
bool is_data_uri(std::string_view uri);

struct DataUri {
  std::string mime;   ///< lower case, without parameters; may be empty
  std::string bytes;  ///< decoded
};

/// Decodes base64 and percent-encoded data URIs. Errors: bad_format.
Result<DataUri> decode_data_uri(std::string_view uri, const std::string& where);

/// The file that a relative URI names under `folder`. Percent-decoded; a backslash counts as a slash.
/// Errors: bad_format for one that has a scheme, is absolute, climbs out of the folder or holds a zero byte.
Result<std::filesystem::path> resolve_uri(const std::filesystem::path& folder, std::string_view uri,
                                          const std::string& where);

/// A file name as a URI: everything but unreserved characters percent-encoded.
std::string encode_uri(std::string_view name);

}  // namespace lodestone::io
