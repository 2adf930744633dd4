// Words and numbers of one line of an OBJ, scanned in place.
#pragma once

#include <fast_float/fast_float.h>

#include <cstdint>
#include <string_view>

#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

class WordScanner {
 public:
  explicit WordScanner(std::string_view line) : next_(line.data()), end_(line.data() + line.size()) {}

  bool at_end() {
    while (next_ < end_ && is_space(*next_)) ++next_;
    return next_ == end_ || *next_ == '#';
  }
  std::string_view rest() const { return {next_, static_cast<std::size_t>(end_ - next_)}; }

  /// Empty at the end of the line.
  std::string_view word() {
    while (next_ < end_ && is_space(*next_)) ++next_;
    const char* begin = next_;
    while (next_ < end_ && !is_space(*next_)) ++next_;
    return {begin, static_cast<std::size_t>(next_ - begin)};
  }

  /// The next word as a number. False, with nothing consumed, if it is none.
  template <class T>
  bool number(T& value) {
    if (at_end()) return false;
    const char* from = next_;
    if (*from == '+' && from + 1 < end_ && from[1] != '-') ++from;
    const auto result = fast_float::from_chars(from, end_, value);
    if (result.ec == std::errc::invalid_argument) return false;
    if (result.ptr != end_ && !is_space(*result.ptr)) return false;
    next_ = result.ptr;
    return true;
  }

  /// An integer here, without blanks before it. False if there is none or it is beyond 18 digits.
  bool integer(std::int64_t& value) {
    const char* from = next_;
    const bool negative = from < end_ && *from == '-';
    if (from < end_ && (*from == '-' || *from == '+')) ++from;
    const char* digits = from;
    std::int64_t sum = 0;
    while (from < end_ && *from >= '0' && *from <= '9' && from - digits < 18) sum = sum * 10 + (*from++ - '0');
    if (from == digits || (from < end_ && *from >= '0' && *from <= '9')) return false;
    value = negative ? -sum : sum;
    next_ = from;
    return true;
  }

  /// Consumes this character if it is next.
  bool take(char c) {
    if (next_ == end_ || *next_ != c) return false;
    ++next_;
    return true;
  }
  /// True where a word may end.
  bool at_word_end() const { return next_ == end_ || is_space(*next_); }

 private:
  const char* next_;
  const char* end_;
};

}  // namespace lodestone::io
