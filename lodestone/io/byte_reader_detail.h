// ByteReader: the bytes of a file (or of memory, for tests and fuzzing) in order, through a window of fixed size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lodestone/base/file.h"
#include "lodestone/base/result.h"

namespace lodestone::io {

/// Move-only. Read errors of the system end the bytes early; status() tells them.
class ByteReader {
 public:
  /// Errors: cannot_read; empty for a file of 0 bytes. A pipe, whose size nobody knows, is read into memory.
  static Result<ByteReader> open(const std::filesystem::path& path);
  /// Reads `bytes` in place; they must outlive the reader. `name` is what messages call them.
  static ByteReader over(std::span<const std::byte> bytes, std::string name);

  /// The path as the user gave it.
  const std::string& name() const { return name_; }
  std::uint64_t size() const { return size_; }
  /// Of the next byte.
  std::uint64_t position() const { return base_ + static_cast<std::uint64_t>(next_ - begin_); }
  /// Bytes from position() to the end, as the system told the size.
  std::uint64_t remaining() const { return size_ > position() ? size_ - position() : 0; }

  /// The bytes in the window: available() of them.
  const char* data() const { return next_; }
  std::size_t available() const { return static_cast<std::size_t>(end_ - next_); }
  /// Steps over bytes of the window.
  void skip(std::size_t n) { next_ += n; }
  /// True if at least n bytes are in the window, after reading more if needed. False: the file has no n more bytes.
  bool ensure(std::size_t n) { return available() >= n || refill(n); }
  /// Copies up to into.size() bytes past the window; fewer only at the end.
  std::size_t read(std::span<std::byte> into);
  /// Steps over n bytes, in the window or not. False: fewer are left.
  bool skip_far(std::uint64_t n);
  /// Continues at an offset from the start.
  void seek(std::uint64_t offset);
  /// An error of the system while reading, if there was one.
  Result<void> status() const;

 private:
  ByteReader() = default;
  bool refill(std::size_t n);
  std::string name_;
  std::uint64_t size_ = 0;
  std::optional<InputFile> file_;  // none: everything is in the window
  std::vector<char> buffer_;
  std::uint64_t base_ = 0;  // offset in the file of *begin_
  const char* begin_ = nullptr;
  const char* next_ = nullptr;
  const char* end_ = nullptr;
  bool ended_ = false;
  std::optional<Error> error_;
};

}  // namespace lodestone::io
