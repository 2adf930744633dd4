// Files: reading with the real size known, and writing so that a failed or interrupted run leaves nothing behind.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/base/result.h"

namespace lodestone {

/// A regular file opened for reading in order. Move-only.
class InputFile {
 public:
  /// Errors: cannot_read (missing, no permission, a directory, a pipe, a device), with a line for the user.
  static Result<InputFile> open(const std::filesystem::path& path);
  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&& other) noexcept;
  ~InputFile();

  /// Bytes of the whole file as the system tells it.
  std::uint64_t size() const { return size_; }
  std::uint64_t position() const { return position_; }
  const std::filesystem::path& path() const { return path_; }

  /// Reads up to `into.size()` bytes; fewer only at the end of the file. Errors: cannot_read.
  Result<std::size_t> read(std::span<std::byte> into);
  /// Moves to a byte offset from the start. Errors: cannot_read.
  Result<void> seek(std::uint64_t offset);

 private:
  InputFile() = default;
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
};

/// The ending of a name in lower case, with its dot: ".ply"; empty without one.
std::string extension_of(const std::filesystem::path& path);

/// Whether both names lead to one existing file.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// The whole file. Errors: cannot_read.
Result<std::string> read_file(const std::filesystem::path& path);

/// Where the bytes of an output go: `path`, or, where that is a symbolic link, the end of its links, so that a link
/// stays one; the file there need not exist yet. Errors: cannot_write (it exists and is write-protected, even from an
/// administrator, or is no regular file; links in a circle, or into a folder that doesn't exist).
Result<std::filesystem::path> output_place(const std::filesystem::path& path);

/// An output that appears under its name whole, or not at all: written as a nameless (or, where the file system has
/// none, a hidden) file in the same folder and renamed by commit(). Without commit() an existing file keeps its bytes.
/// A symbolic link is followed.
class OutputFile {
 public:
  /// Errors: cannot_write (no such folder, no permission, those of output_place()).
  static Result<OutputFile> create(const std::filesystem::path& path);
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  ~OutputFile();

  /// Appends, buffered. Errors (such as a full disk) are kept and told by commit(); writing after one does nothing.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  std::uint64_t size() const { return written_; }
  const std::filesystem::path& path() const { return path_; }
  /// True once a write has failed: long writers may stop early.
  bool failed() const { return error_number_ != 0; }

  /// Flushes and puts the file under its name. Errors: cannot_write.
  Result<void> commit();

 private:
  OutputFile() = default;
  void flush();
  void discard() noexcept;
  std::filesystem::path path_;
  std::filesystem::path place_;   // where links of path_ lead
  std::filesystem::path hidden_;  // beside place_; empty while the file has no name
  int descriptor_ = -1;
  int error_number_ = 0;
  std::uint64_t written_ = 0;
  std::string buffer_;
};

/// A hidden folder beside an output that consists of several files: what is written into it appears beside it on
/// commit(), and is gone without. Symbolic links there are followed.
class StagingFolder {
 public:
  /// In the folder of `output`. Errors: cannot_write.
  static Result<StagingFolder> create(const std::filesystem::path& output);
  StagingFolder(StagingFolder&& other) noexcept;
  StagingFolder& operator=(StagingFolder&&) = delete;
  ~StagingFolder();

  /// Where to write.
  std::filesystem::path path() const { return hidden_ / "new"; }
  /// Moves every file in path() to its place, over older ones: all of them, or, on an error, none; older files are then
  /// back as they were. Errors: cannot_write, with the place that could not be taken.
  Result<void> commit();

 private:
  StagingFolder() = default;
  // A file on its way: from `fresh` to `place`, and what was there before to `aside`.
  struct Move {
    std::filesystem::path fresh, place, aside;
  };
  Result<std::vector<Move>> plan_moves() const;
  Result<void> bring_beside(Move& move);
  int put_in_place(const Move& move);
  bool restore(const Move& move);

  std::filesystem::path folder_;                  // of the output; empty = the present one
  std::filesystem::path hidden_;                  // holds "new" and, during commit(), "old"; empty once moved from
  std::vector<std::filesystem::path> elsewhere_;  // the same beside what links lead to, during commit()
  bool keep_hidden_ = false;
};

}  // namespace lodestone
