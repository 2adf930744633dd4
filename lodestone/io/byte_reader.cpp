#include <algorithm>
#include <cstring>

#include "lodestone/io/byte_reader_detail.h"

namespace lodestone::io {

namespace {
constexpr std::size_t kWindowBytes = std::size_t{1} << 20;
}

Result<ByteReader> ByteReader::open(const std::filesystem::path& path) {
  Result<InputFile> file = InputFile::open(path);
  LODESTONE_TRY(file);
  ByteReader reader;
  reader.name_ = path.string();
  if (file->size() == 0) {
    Result<std::string> bytes = read_file(path);
    LODESTONE_TRY(bytes);
    if (bytes->empty()) {
      return fail(ErrorCode::empty, "is empty (0 bytes)", path.string(), "was the copy or the export interrupted?");
    }
    // Into the buffer and not a string: a moved small string would change its address.
    reader.buffer_.assign(bytes->begin(), bytes->end());
    reader.size_ = reader.buffer_.size();
    reader.begin_ = reader.next_ = reader.buffer_.data();
    reader.end_ = reader.begin_ + reader.size_;
    reader.ended_ = true;
    return reader;
  }
  reader.size_ = file->size();
  reader.file_ = std::move(*file);
  reader.buffer_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kWindowBytes, reader.size_)));
  reader.begin_ = reader.next_ = reader.end_ = reader.buffer_.data();
  return reader;
}

ByteReader ByteReader::over(std::span<const std::byte> bytes, std::string name) {
  ByteReader reader;
  reader.name_ = std::move(name);
  reader.size_ = bytes.size();
  reader.begin_ = reader.next_ = reinterpret_cast<const char*>(bytes.data());
  reader.end_ = reader.begin_ + bytes.size();
  reader.ended_ = true;
  return reader;
}

bool ByteReader::refill(std::size_t n) {
  if (ended_) return false;
  if (n > buffer_.size()) {
    if (n > remaining()) return false;  // never grows beyond what the file really has
    std::vector<char> larger(std::max(n, std::min<std::size_t>(2 * buffer_.size(), size_)));
    const std::size_t kept = available();
    std::copy(next_, end_, larger.begin());
    base_ = position();
    buffer_.swap(larger);
    begin_ = next_ = buffer_.data();
    end_ = begin_ + kept;
  } else {
    const std::size_t kept = available();
    base_ = position();
    std::memmove(buffer_.data(), next_, kept);
    begin_ = next_ = buffer_.data();
    end_ = begin_ + kept;
  }
  const std::size_t kept = available();
  const Result<std::size_t> got = file_->read(std::as_writable_bytes(std::span(buffer_).subspan(kept)));
  if (!got) {
    error_ = got.error();
    ended_ = true;
    return false;
  }
  end_ += *got;
  if (*got < buffer_.size() - kept) ended_ = true;
  return available() >= n;
}

std::size_t ByteReader::read(std::span<std::byte> into) {
  const std::size_t first = std::min(available(), into.size());
  if (first > 0) std::memcpy(into.data(), next_, first);
  next_ += first;
  if (first == into.size() || ended_) return first;
  const Result<std::size_t> got = file_->read(into.subspan(first));
  if (!got) {
    error_ = got.error();
    ended_ = true;
    return first;
  }
  base_ = position() + *got;
  begin_ = next_ = end_ = buffer_.data();
  if (*got < into.size() - first) ended_ = true;
  return first + *got;
}

bool ByteReader::skip_far(std::uint64_t n) {
  if (n <= available()) {
    skip(static_cast<std::size_t>(n));
    return true;
  }
  if (n > remaining()) return false;
  seek(position() + n);
  return true;
}

void ByteReader::seek(std::uint64_t offset) {
  if (offset >= base_ && offset <= base_ + static_cast<std::uint64_t>(end_ - begin_)) {
    next_ = begin_ + (offset - base_);
    return;
  }
  if (!file_) {
    next_ = end_;
    return;
  }
  if (const Result<void> moved = file_->seek(offset); !moved) {
    error_ = moved.error();
    ended_ = true;
    next_ = end_;
    return;
  }
  base_ = offset;
  begin_ = next_ = end_ = buffer_.data();
  ended_ = false;
}

Result<void> ByteReader::status() const {
  if (error_) return fail(*error_);
  return {};
}

}  // namespace lodestone::io
