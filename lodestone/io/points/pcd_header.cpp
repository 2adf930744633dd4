#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "lodestone/base/text.h"
#include "lodestone/io/points/pcd_header_detail.h"
#include "lodestone/io/read_detail.h"
#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

namespace {

constexpr std::size_t kMostFields = 1000;
constexpr std::int64_t kMostNumbers = 1 << 20;  // of one field

PcdRole role_of(std::string_view name) {
  using enum PcdRole;
  constexpr std::array<std::pair<std::string_view, PcdRole>, 11> kNames{{{"x", x},
                                                                         {"y", y},
                                                                         {"z", z},
                                                                         {"normal_x", normal_x},
                                                                         {"normal_y", normal_y},
                                                                         {"normal_z", normal_z},
                                                                         {"rgb", rgb},
                                                                         {"rgba", rgba},
                                                                         {"red", red},
                                                                         {"green", green},
                                                                         {"blue", blue}}};
  const std::string lower = lower_case(name);
  for (const auto& [word, role] : kNames) {
    if (word == lower) return role;
  }
  return other;
}

class HeaderParser {
 public:
  explicit HeaderParser(ByteReader& bytes) : bytes_(bytes), text_(bytes) {}

  Result<PcdHeader> parse() {
    std::string_view line;
    constexpr std::uint64_t kLongestHeader = std::uint64_t{1} << 20;
    while (header_.data_begin == 0) {
      if (bytes_.position() > kLongestHeader || !text_.next_line(line)) {
        return bad("the header has no line 'DATA'", "is the file cut off?");
      }
      std::string_view rest = trimmed(line);
      if (rest.empty() || rest.front() == '#') continue;
      const std::string_view key = next_word(rest);
      LODESTONE_TRY(take(key, rest));
    }
    header_.lines = text_.line();
    LODESTONE_TRY(finish());
    return std::move(header_);
  }

 private:
  tl::unexpected<Error> bad(std::string what, std::string remedy = "is the file damaged?") const {
    return fail(ErrorCode::bad_format, std::move(what), text_.place(), std::move(remedy));
  }

  Result<void> take(std::string_view key, std::string_view rest) {
    if (key == "VERSION" || key == "VIEWPOINT") return {};
    if (key == "FIELDS" || key == "COLUMNS") return take_fields(rest);
    if (key == "SIZE" || key == "TYPE" || key == "COUNT") return take_each(key, rest);
    if (key == "WIDTH") return take_number(key, rest, width_);
    if (key == "HEIGHT") return take_number(key, rest, height_);
    if (key == "POINTS") return take_number(key, rest, points_);
    if (key == "DATA") return take_data(rest);
    if (header_.fields.empty()) return bad("has no header of a PCD file", "is it one?");
    return bad(fmt::format("'{}' is not a keyword of a PCD header", key.substr(0, 40)));
  }

  Result<void> take_fields(std::string_view rest) {
    if (!header_.fields.empty()) return bad("the header names its fields twice");
    for (std::string_view name = next_word(rest); !name.empty(); name = next_word(rest)) {
      PcdField field;
      field.name = name;
      field.role = role_of(name);
      if (field.role != PcdRole::other && header_.has(field.role)) {
        return bad(fmt::format("field '{}' comes twice", name.substr(0, 40)));
      }
      header_.fields.push_back(std::move(field));
      if (header_.fields.size() > kMostFields) return bad(fmt::format("has more than {} fields", kMostFields));
    }
    return {};
  }

  // A value for each field.
  Result<void> take_each(std::string_view key, std::string_view rest) {
    for (PcdField& field : header_.fields) {
      const std::string_view word = next_word(rest);
      if (word.empty()) return bad(fmt::format("{} says less than FIELDS", key));
      if (key == "TYPE") {
        if (word != "F" && word != "I" && word != "U") {
          return bad(fmt::format("type '{}' is none of F, I, U", word.substr(0, 40)));
        }
        field.type = word.front();
        continue;
      }
      std::int64_t value = 0;
      if (!parse_integer(word, value) || value < 1 || value > kMostNumbers) {
        return bad(fmt::format("{} '{}' of field '{}' can't be", key, word.substr(0, 40), field.name.substr(0, 40)));
      }
      (key == "SIZE" ? field.size : field.count) = static_cast<std::uint32_t>(value);
    }
    if (!next_word(rest).empty()) return bad(fmt::format("{} says more than FIELDS", key));
    return {};
  }

  Result<void> take_number(std::string_view key, std::string_view rest, std::optional<std::uint64_t>& into) {
    const std::string_view word = next_word(rest);
    std::int64_t value = 0;
    if (!parse_integer(word, value) || value < 0) {
      return bad(fmt::format("'{}' is not a number for {}", word.substr(0, 40), key));
    }
    into = static_cast<std::uint64_t>(value);
    return {};
  }

  Result<void> take_data(std::string_view rest) {
    const std::string_view word = next_word(rest);
    if (word == "ascii") {
      header_.data = PcdData::ascii;
    } else if (word == "binary") {
      header_.data = PcdData::binary;
    } else if (word == "binary_compressed") {
      header_.data = PcdData::binary_compressed;
    } else {
      return bad(fmt::format("data '{}' are none of ascii, binary, binary_compressed", word.substr(0, 40)));
    }
    header_.data_begin = bytes_.position();
    return {};
  }

  Result<void> finish() {
    for (const auto& [role, name] : {std::pair{PcdRole::x, 'x'}, {PcdRole::y, 'y'}, {PcdRole::z, 'z'}}) {
      if (!header_.has(role)) return bad(fmt::format("the points have no field '{}'", name), "is it a point cloud?");
    }
    for (PcdField& field : header_.fields) {
      const bool known = field.size == 1 || field.size == 2 || field.size == 4 || field.size == 8;
      if (field.role != PcdRole::other && (!known || (field.type == 'F' && field.size < 4) || field.count != 1)) {
        return fail(ErrorCode::unsupported,
                    fmt::format("field '{}' has {} of type {} and {} bytes", field.name.substr(0, 40),
                                counted(field.count, "number", "numbers"), field.type, field.size),
                    text_.place(), "save it with floats");
      }
      // A packed colour is four bytes, whatever they are called.
      if ((field.role == PcdRole::rgb || field.role == PcdRole::rgba) && field.size != 4) field.role = PcdRole::other;
      field.offset = header_.record_bytes;
      header_.record_bytes += std::uint64_t{field.size} * field.count;
      header_.numbers += field.count;
    }
    if (!points_ && width_ && height_) {
      if (*height_ > 0 && *width_ > (~std::uint64_t{0} >> 1) / *height_) return bad("WIDTH times HEIGHT is too large");
      points_ = *width_ * *height_;
    }
    if (!points_) return bad("the header has no line 'POINTS'");
    header_.points = *points_;
    return {};
  }

  ByteReader& bytes_;
  TextReader text_;
  PcdHeader header_;
  std::optional<std::uint64_t> width_, height_, points_;
};

}  // namespace

Result<PcdHeader> read_pcd_header(ByteReader& bytes) { return HeaderParser(bytes).parse(); }

}  // namespace lodestone::io
