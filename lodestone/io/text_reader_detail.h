// TextReader: words and lines of a text file with their line numbers, and numbers from words.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "lodestone/io/byte_reader_detail.h"

namespace lodestone::io {

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
inline bool is_space(char c) { return is_blank(c) || c == '\n'; }

/// Views that are handed out hold until the next call.
class TextReader {
 public:
  /// `comment` begins a comment that lasts to the end of the line; 0 = there are none (words and lines apart: lines
  /// keep theirs). `line` is the number of the line at which `bytes` stands.
  explicit TextReader(ByteReader& bytes, char comment = 0, std::uint64_t line = 1)
      : bytes_(bytes), comment_(comment), line_(line) {}

  /// The next word, on this line or a later one; empty at the end of the file.
  std::string_view word();
  /// The next word of this line; empty at its end (the line's end is not consumed).
  std::string_view word_on_line();
  /// Consumes what is left of this line and its end.
  void skip_line();
  /// Takes the whole next line without its end ("\n" or "\r\n"). False at the end of the file.
  bool next_line(std::string_view& line);

  /// Number of the line of the last word or line that was handed out, from 1.
  std::uint64_t line() const { return word_line_; }
  /// "file.off:14"
  std::string place() const;
  ByteReader& bytes() { return bytes_; }

 private:
  std::string_view take_word();
  ByteReader& bytes_;
  char comment_;
  std::uint64_t line_;
  std::uint64_t word_line_ = 1;
};

/// The whole word as a number, correctly rounded, locale or not; a leading '+' is taken. "inf" and "nan" are numbers
/// here.
bool parse_number(std::string_view word, double& value);
bool parse_number(std::string_view word, float& value);
/// The whole word as an integer; false for anything else and beyond 64 bits.
bool parse_integer(std::string_view word, std::int64_t& value);

/// Takes the next word off the front of `line`; empty when there is none.
std::string_view next_word(std::string_view& line);
/// Without blanks at both ends.
std::string_view trimmed(std::string_view text);

}  // namespace lodestone::io
