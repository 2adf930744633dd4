// Formats that other people's libraries read are read in a child process with limits on memory and time, so that a
// crash or a hang there is an ordinary error here.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"

namespace lodestone::app {

/// Starts this program again as the reader, waits for it, and reads the GLB that it made.
/// Errors: those of io::read_model; bad_format when the reader crashed or ran into a limit; cancelled.
Result<Model> read_foreign(const std::filesystem::path& path, Task task);

/// The hidden verb that the child runs.
inline constexpr const char* kForeignVerb = "__read-foreign";
/// Its main: `words` are the input and the GLB to write; what it has to say goes to file descriptor 3.
int foreign_main(const std::vector<std::string>& words);

}  // namespace lodestone::app
