// What the plain writers share.
#pragma once

#include <filesystem>
#include <string>

#include "lodestone/base/result.h"
#include "lodestone/core/model.h"
#include "lodestone/io/write.h"

namespace lodestone::io {

/// Errors: bad_argument (those of validate()), empty if the model draws nothing, cancelled.
Result<void> check_drawn(const Model& model, const std::filesystem::path& path, const Task& task);

/// A report of one file.
WriteReport single_file_report(const std::filesystem::path& path, std::uint64_t bytes,
                               std::vector<std::string> warnings);

/// Tells which attributes, materials and names a format without them leaves out.
void warn_of_losses(const Mesh& mesh, const char* format, std::vector<std::string>& warnings);

/// Shortest text that reads back as the same number.
void append_number(std::string& out, float value);
void append_number(std::string& out, double value);

}  // namespace lodestone::io
