#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "lodestone/io/points/read_detail.h"
#include "lodestone/io/read_detail.h"
#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

namespace {

constexpr std::size_t kMostColumns = 16;  // what comes behind them is left out

bool separates(char c) { return is_space(c) || c == ',' || c == ';'; }

// Takes the next number's text off the front of a line.
std::string_view next_field(std::string_view& line) {
  std::size_t begin = 0;
  while (begin < line.size() && separates(line[begin])) ++begin;
  std::size_t end = begin;
  while (end < line.size() && !separates(line[end])) ++end;
  const std::string_view field = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return field;
}

bool is_comment(std::string_view line) { return line.starts_with('#') || line.starts_with("//"); }

// What three columns hold, from all their rows.
class Triple {
 public:
  void add(const float* values) {
    ++rows_;
    double length_sq = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto v = static_cast<double>(values[i]);
      length_sq += v * v;
      bytes_ = bytes_ && v >= 0 && v <= 255 && v == std::floor(v);
      largest_ = std::max(largest_, v);
    }
    // NaN and zero stand for unknown ones.
    if (!std::isfinite(length_sq) || length_sq == 0) {
      ++unknown_;
    } else if (length_sq < 0.9 || length_sq > 1.1) {
      ++others_;
    }
  }
  // Files with few digits round; a hundredth of the rows may be worse.
  bool are_normals() const { return unknown_ < rows_ && others_ * 100 <= rows_; }
  bool are_colors() const { return rows_ > 0 && bytes_ && largest_ > 1; }

 private:
  std::uint64_t rows_ = 0, unknown_ = 0, others_ = 0;
  bool bytes_ = true;
  double largest_ = 0;
};

class TextPoints {
 public:
  TextPoints(ByteReader bytes, const Task& task)
      : bytes_(std::move(bytes)), text_(bytes_), progress_(task, bytes_.size()) {}

  Result<PointCloud> read() {
    std::string_view line;
    while (text_.next_line(line)) {
      line = trimmed(line);
      if (line.empty() || is_comment(line)) continue;
      LODESTONE_TRY(columns_ == 0 ? first_line(line) : take(line));
      if (raw_.positions.size() % 4096 == 0 && !progress_.go_on(bytes_.position())) return cancelled_error("reading");
    }
    LODESTONE_TRY(bytes_.status());
    take_extras();
    return finish_points(std::move(raw_), bytes_.name());
  }

 private:
  tl::unexpected<Error> bad(std::string what, std::string remedy) const {
    return fail(ErrorCode::bad_format, std::move(what), text_.place(), std::move(remedy));
  }

  // A line of names or a count may stand before the first point.
  Result<void> first_line(std::string_view line) {
    std::size_t columns = 0;
    std::string_view rest = line;
    for (std::string_view field = next_field(rest); !field.empty(); field = next_field(rest)) {
      double value = 0;
      if (!parse_number(field, value)) {
        if (headings_++ > 0) {
          return bad(fmt::format("'{}' is not a number", field.substr(0, 40)), "is it a list of points: x y z a line?");
        }
        return {};
      }
      ++columns;
    }
    if (columns == 1 && headings_++ == 0) return {};
    if (columns < 3)
      return bad(fmt::format("has {} where x y z should be", counted(columns, "number", "numbers")),
                 "is it a list of points: x y z a line?");
    columns_ = std::min(columns, kMostColumns);
    if (columns > kMostColumns) {
      raw_.warnings.push_back(fmt::format("columns after the {}th were left out", kMostColumns));
    }
    return take(line);
  }

  Result<void> take(std::string_view line) {
    Vec3d p;
    for (std::size_t c = 0; c < columns_; ++c) {
      const std::string_view field = next_field(line);
      double value = 0;
      if (!parse_number(field, value)) {
        return field.empty() ? bad(fmt::format("has {} columns where the first point has {}", c, columns_),
                                   "is the file damaged or cut off?")
                             : bad(fmt::format("'{}' is not a number", field.substr(0, 40)), "is the file damaged?");
      }
      if (c < 3) {
        p[c] = value;
      } else {
        extras_.push_back(static_cast<float>(value));
      }
    }
    raw_.positions.push_back(p);
    return {};
  }

  // Which of the columns behind x y z are normals and colours.
  void take_extras() {
    const std::size_t width = columns_ > 3 ? columns_ - 3 : 0;
    std::size_t used = 0;
    for (std::size_t c = 0; c + 3 <= width;) {
      Triple triple;
      for (std::size_t i = 0; i < raw_.positions.size(); ++i) triple.add(extras_.data() + i * width + c);
      if (triple.are_normals() && raw_.normals.empty()) {
        raw_.normals.resize(raw_.positions.size());
        for (std::size_t i = 0; i < raw_.normals.size(); ++i) {
          const float* v = extras_.data() + i * width + c;
          raw_.normals[i] = {v[0], v[1], v[2]};
        }
      } else if (triple.are_colors() && raw_.colors.empty()) {
        raw_.colors.resize(raw_.positions.size());
        for (std::size_t i = 0; i < raw_.colors.size(); ++i) {
          const float* v = extras_.data() + i * width + c;
          raw_.colors[i] = {static_cast<std::uint8_t>(v[0]), static_cast<std::uint8_t>(v[1]),
                            static_cast<std::uint8_t>(v[2]), 255};
        }
      } else {
        ++c;
        continue;
      }
      used += 3;
      c += 3;
    }
    if (used < width) {
      raw_.warnings.push_back(fmt::format("{} beside x y z left out: neither normals nor colours",
                                          counted(width - used, "column", "columns")));
    }
  }

  ByteReader bytes_;
  TextReader text_;
  ReadProgress progress_;
  RawPoints raw_;
  std::size_t columns_ = 0;  // of the first point; 0 = there was none yet
  int headings_ = 0;
  std::vector<float> extras_;  // columns from the fourth on
};

}  // namespace

Result<PointCloud> read_text_points(ByteReader bytes, const Task& task) {
  return TextPoints(std::move(bytes), task).read();
}

}  // namespace lodestone::io
