// What a file that can't be read seems to be instead of what its name says.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lodestone/base/result.h"

namespace lodestone::io {

/// What the first bytes of a file say.
struct Content {
  std::string_view name;       ///< "a ZIP archive"; empty = nothing that is known
  std::string_view extension;  ///< of a format that we read: ".ply"; else empty
  std::string_view remedy;     ///< what to do where a model was expected
};

/// By the bytes that formats begin with; some 512 bytes are enough. `file_size` is that of the whole file, in bytes.
Content content_of(std::string_view head, std::uint64_t file_size);

/// The error of a reader that could not make sense of `path`; told anew if the file is of another kind than its name
/// says: "x.glb: looks like a ZIP archive, not .glb; unpack it and name the model inside". Other errors stay.
Error told_by_content(Error error, const std::filesystem::path& path);

}  // namespace lodestone::io
