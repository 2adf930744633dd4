#include <fast_float/fast_float.h>

#include <charconv>
#include <cstring>

#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

std::string_view TextReader::take_word() {
  word_line_ = line_;
  std::size_t length = 0;
  while (true) {
    const char* data = bytes_.data();
    const std::size_t available = bytes_.available();
    while (length < available && !is_space(data[length])) ++length;
    if (length < available || !bytes_.ensure(available + 1)) break;
  }
  const std::string_view word(bytes_.data(), length);
  bytes_.skip(length);
  if (comment_ != 0) {
    if (const std::size_t at = word.find(comment_); at != std::string_view::npos && at > 0) {
      // The comment follows without a blank: hand out what stands before it, drop the rest of the line.
      bytes_.seek(bytes_.position() - (length - at));
      return {bytes_.data() - at, at};
    }
  }
  return word;
}

std::string_view TextReader::word() {
  while (true) {
    const std::string_view found = word_on_line();
    if (!found.empty()) return found;
    if (!bytes_.ensure(1)) return {};
    bytes_.skip(1);
    ++line_;
  }
}

std::string_view TextReader::word_on_line() {
  while (bytes_.ensure(1)) {
    const char c = *bytes_.data();
    if (is_blank(c)) {
      bytes_.skip(1);
    } else if (c == '\n') {
      return {};
    } else if (c == comment_ && comment_ != 0) {
      while (bytes_.ensure(1) && *bytes_.data() != '\n') {
        const void* end = std::memchr(bytes_.data(), '\n', bytes_.available());
        bytes_.skip(end ? static_cast<std::size_t>(static_cast<const char*>(end) - bytes_.data()) : bytes_.available());
      }
      return {};
    } else {
      return take_word();
    }
  }
  return {};
}

void TextReader::skip_line() {
  while (bytes_.ensure(1)) {
    const void* end = std::memchr(bytes_.data(), '\n', bytes_.available());
    if (end != nullptr) {
      bytes_.skip(static_cast<std::size_t>(static_cast<const char*>(end) - bytes_.data()) + 1);
      ++line_;
      return;
    }
    bytes_.skip(bytes_.available());
  }
}

bool TextReader::next_line(std::string_view& line) {
  word_line_ = line_;
  std::size_t seen = 0;
  while (true) {
    const void* end =
        bytes_.available() > seen ? std::memchr(bytes_.data() + seen, '\n', bytes_.available() - seen) : nullptr;
    if (end != nullptr) {
      line = {bytes_.data(), static_cast<std::size_t>(static_cast<const char*>(end) - bytes_.data())};
      bytes_.skip(line.size() + 1);
      ++line_;
      break;
    }
    seen = bytes_.available();
    if (!bytes_.ensure(seen + 1)) {
      if (seen == 0) return false;
      line = {bytes_.data(), seen};
      bytes_.skip(seen);
      break;
    }
  }
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return true;
}

std::string TextReader::place() const { return bytes_.name() + ":" + std::to_string(word_line_); }

namespace {

template <class T>
bool parse_whole(std::string_view word, T& value) {
  if (!word.empty() && word.front() == '+' && word.size() > 1 && word[1] != '-') word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto result = fast_float::from_chars(word.data(), end, value);
  return result.ptr == end && result.ec != std::errc::invalid_argument && !word.empty();
}

}  // namespace

bool parse_number(std::string_view word, double& value) { return parse_whole(word, value); }
bool parse_number(std::string_view word, float& value) { return parse_whole(word, value); }

bool parse_integer(std::string_view word, std::int64_t& value) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, value);
  return result.ec == std::errc() && result.ptr == end;
}

std::string_view next_word(std::string_view& line) {
  std::size_t begin = 0;
  while (begin < line.size() && is_space(line[begin])) ++begin;
  std::size_t end = begin;
  while (end < line.size() && !is_space(line[end])) ++end;
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace lodestone::io
