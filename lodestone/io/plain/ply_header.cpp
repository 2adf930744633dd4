#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "lodestone/io/plain/ply_header_detail.h"
#include "lodestone/io/read_detail.h"
#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

int PlyElement::find(std::string_view property) const {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == property) return static_cast<int>(i);
  }
  return -1;
}

bool PlyElement::has_lists() const {
  return std::any_of(properties.begin(), properties.end(), [](const PlyProperty& p) { return p.is_list; });
}

std::uint64_t PlyElement::smallest_record(PlyFormat format) const {
  if (format == PlyFormat::ascii) return 2 * properties.size();  // a digit and a blank each
  std::uint64_t bytes = 0;
  for (const PlyProperty& p : properties) bytes += size_of(p.is_list ? p.count_type : p.type);
  return bytes;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
  for (const PlyElement& e : elements) {
    if (e.name == element) return &e;
  }
  return nullptr;
}

namespace {

std::optional<ComponentType> type_of(std::string_view word) {
  using enum ComponentType;
  constexpr std::array<std::pair<std::string_view, ComponentType>, 16> kTypes{{{"char", int8},
                                                                               {"int8", int8},
                                                                               {"uchar", uint8},
                                                                               {"uint8", uint8},
                                                                               {"short", int16},
                                                                               {"int16", int16},
                                                                               {"ushort", uint16},
                                                                               {"uint16", uint16},
                                                                               {"int", int32},
                                                                               {"int32", int32},
                                                                               {"uint", uint32},
                                                                               {"uint32", uint32},
                                                                               {"float", float32},
                                                                               {"float32", float32},
                                                                               {"double", float64},
                                                                               {"float64", float64}}};
  for (const auto& [name, type] : kTypes) {
    if (name == word) return type;
  }
  return std::nullopt;
}

// Lines that end as the first one does: "\n", "\r\n", or "\r" as in very old files.
class HeaderLines {
 public:
  explicit HeaderLines(ByteReader& bytes) : bytes_(bytes) {}

  // False at the end of the file or of what may be a header.
  bool next(std::string& line) {
    constexpr std::size_t kLongestHeader = std::size_t{1} << 20;
    line.clear();
    while (bytes_.position() < kLongestHeader && bytes_.ensure(1)) {
      const char c = *bytes_.data();
      bytes_.skip(1);
      if (c == '\n' || (c == '\r' && ends_with_return())) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        ++number;
        return true;
      }
      line += c;
    }
    ++number;
    return false;
  }
  std::uint64_t number = 0;

 private:
  // Decided at the first line's end.
  bool ends_with_return() {
    if (number == 0) return_only_ = !(bytes_.ensure(1) && *bytes_.data() == '\n');
    return return_only_;
  }
  ByteReader& bytes_;
  bool return_only_ = false;
};

class HeaderParser {
 public:
  explicit HeaderParser(ByteReader& bytes) : bytes_(bytes), lines_(bytes) {}

  Result<PlyHeader> parse() {
    std::string line;
    if (!lines_.next(line) || trimmed(line) != "ply") {
      return fail(ErrorCode::bad_format, "does not begin with a line 'ply'", bytes_.name(), "is it a PLY file?");
    }
    bool has_format = false;
    while (true) {
      if (!lines_.next(line)) return bad("the header has no 'end_header'", "is the file cut off?");
      std::string_view rest = line;
      const std::string_view key = next_word(rest);
      Result<void> done;
      if (key == "end_header") break;
      if (key == "format") {
        done = read_format(rest);
        has_format = true;
      } else if (key == "comment") {
        read_comment(rest);
      } else if (key == "element") {
        done = read_element(rest);
      } else if (key == "property") {
        done = read_property(rest);
      } else if (!key.empty() && key != "obj_info") {
        return bad(fmt::format("'{}' is not a keyword of a PLY header", shown(key)), "is the file damaged?");
      }
      LODESTONE_TRY(done);
    }
    if (!has_format) return bad("the header has no line 'format'");
    header_.data_begin = bytes_.position();
    header_.lines = lines_.number;
    LODESTONE_TRY(check_counts());
    return std::move(header_);
  }

 private:
  static std::string shown(std::string_view word) { return std::string(word.substr(0, 40)); }
  tl::unexpected<Error> bad(std::string what, std::string remedy = {}) const {
    return fail(ErrorCode::bad_format, std::move(what), line_place(bytes_.name(), lines_.number), std::move(remedy));
  }

  Result<void> read_format(std::string_view rest) {
    const std::string_view word = next_word(rest);
    if (word == "ascii") {
      header_.format = PlyFormat::ascii;
    } else if (word == "binary_little_endian") {
      header_.format = PlyFormat::binary_little_endian;
    } else if (word == "binary_big_endian") {
      header_.format = PlyFormat::binary_big_endian;
    } else {
      return bad(fmt::format("format '{}' is none of ascii, binary_little_endian, binary_big_endian", shown(word)));
    }
    return {};
  }

  void read_comment(std::string_view rest) {
    if (next_word(rest) == "TextureFile" && !trimmed(rest).empty()) header_.textures.emplace_back(trimmed(rest));
  }

  Result<void> read_element(std::string_view rest) {
    PlyElement element;
    element.name = next_word(rest);
    element.line = lines_.number;
    const std::string_view count = next_word(rest);
    std::int64_t value = 0;
    if (!parse_integer(count, value)) {
      return bad(fmt::format("'{}' is not a count of '{}'", shown(count), shown(element.name)));
    }
    if (value < 0) return bad(fmt::format("{} count {} is negative", shown(element.name), value));
    element.count = static_cast<std::uint64_t>(value);
    if (header_.find(element.name) != nullptr) return bad(fmt::format("element '{}' comes twice", shown(element.name)));
    header_.elements.push_back(std::move(element));
    return {};
  }

  Result<void> read_property(std::string_view rest) {
    if (header_.elements.empty()) return bad("a property stands before the first element");
    PlyProperty property;
    std::string_view word = next_word(rest);
    property.is_list = word == "list";
    if (property.is_list) {
      const std::optional<ComponentType> count_type = type_of(next_word(rest));
      if (!count_type || *count_type == ComponentType::float32 || *count_type == ComponentType::float64) {
        return bad("a list's count must have an integer type");
      }
      property.count_type = *count_type;
      word = next_word(rest);
    }
    const std::optional<ComponentType> type = type_of(word);
    if (!type) return bad(fmt::format("'{}' is not a type of a property", shown(word)), "is the file damaged?");
    property.type = *type;
    property.name = next_word(rest);
    if (property.name.empty()) return bad("a property has no name");
    if (header_.elements.back().find(property.name) >= 0) {
      return bad(fmt::format("property '{}' comes twice", shown(property.name)));
    }
    header_.elements.back().properties.push_back(std::move(property));
    return {};
  }

  // No count is believed that the bytes behind the header cannot hold.
  Result<void> check_counts() {
    std::uint64_t left = bytes_.remaining() + 1;  // the last number of a text may end with the file
    for (PlyElement& element : header_.elements) {
      const std::uint64_t each = element.smallest_record(header_.format);
      if (each == 0) {  // nothing to read, whatever the count: nor to count through
        element.count = 0;
        continue;
      }
      if (element.count > left / each) {
        return count_too_large(element.name, element.count, each, bytes_.size(),
                               line_place(bytes_.name(), element.line));
      }
      left -= element.count * each;
    }
    return {};
  }

  ByteReader& bytes_;
  HeaderLines lines_;
  PlyHeader header_;
};

}  // namespace

Result<PlyHeader> read_ply_header(ByteReader& bytes) { return HeaderParser(bytes).parse(); }

}  // namespace lodestone::io
