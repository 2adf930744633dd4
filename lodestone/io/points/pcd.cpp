#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "lodestone/io/plain/ply_values_detail.h"
#include "lodestone/io/points/pcd_header_detail.h"
#include "lodestone/io/points/read_detail.h"
#include "lodestone/io/points/wide_colors_detail.h"
#include "lodestone/io/read_detail.h"
#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

namespace {

double number_at(const PcdField& field, const char* from) {
  const auto as = [&](auto zero) { return static_cast<double>(load_number<decltype(zero), false>(from)); };
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1:
      return is_signed ? as(std::int8_t{}) : as(std::uint8_t{});
    case 2:
      return is_signed ? as(std::int16_t{}) : as(std::uint16_t{});
    case 4:
      return field.type == 'F' ? as(float{}) : is_signed ? as(std::int32_t{}) : as(std::uint32_t{});
    default:
      return field.type == 'F' ? as(double{}) : is_signed ? as(std::int64_t{}) : as(std::uint64_t{});
  }
}

std::uint16_t to_word(double value) { return static_cast<std::uint16_t>(value > 0 ? std::min(value, 65535.0) : 0.0); }

// One point as its fields come.
struct Row {
  Vec3d position;
  Vec3f normal;
  std::uint32_t packed = 0;  // 0xAARRGGBB
  std::array<std::uint16_t, 3> color{};

  void set(PcdRole role, double value) {
    const auto at = static_cast<std::size_t>(role);
    if (role <= PcdRole::z) {
      position[at] = value;
    } else if (role <= PcdRole::normal_z) {
      normal[at - 3] = static_cast<float>(value);
    } else if (role >= PcdRole::red && role <= PcdRole::blue) {
      color[at - static_cast<std::size_t>(PcdRole::red)] = to_word(value);
    }
  }
};

class PcdReader {
 public:
  PcdReader(ByteReader bytes, const Task& task) : bytes_(std::move(bytes)), progress_(task, bytes_.size()) {}

  Result<PointCloud> read() {
    Result<PcdHeader> header = read_pcd_header(bytes_);
    LODESTONE_TRY(header);
    header_ = std::move(*header);
    plan();
    LODESTONE_TRY(header_.data == PcdData::ascii    ? read_ascii()
                  : header_.data == PcdData::binary ? read_binary()
                                                    : read_compressed());
    LODESTONE_TRY(bytes_.status());
    finish_colors();
    return finish_points(std::move(raw_), bytes_.name());
  }

 private:
  void plan() {
    has_normals_ = header_.has(PcdRole::normal_x) && header_.has(PcdRole::normal_y) && header_.has(PcdRole::normal_z);
    has_packed_ = header_.has(PcdRole::rgb) || header_.has(PcdRole::rgba);
    has_colors_ =
        !has_packed_ && header_.has(PcdRole::red) && header_.has(PcdRole::green) && header_.has(PcdRole::blue);
    std::string left_out;
    for (const PcdField& field : header_.fields) {
      if (field.role != PcdRole::other) {
        used_.push_back(field);
      } else if (field.name != "_") {  // padding
        left_out += fmt::format("{}'{}'", left_out.empty() ? "" : ", ", field.name.substr(0, 40));
      }
    }
    if (!left_out.empty()) raw_.warnings.push_back("left out: " + left_out);
  }

  Result<void> reserve(std::uint64_t bytes_each, std::uint64_t there) {
    if (header_.points > there / bytes_each) {
      return count_too_large("point", header_.points, bytes_each, bytes_.size(),
                             line_place(bytes_.name(), header_.lines));
    }
    if (header_.points >= kNone) return too_many_points(header_.points, bytes_.name());
    const auto n = static_cast<std::size_t>(header_.points);
    raw_.positions.reserve(n);
    if (has_normals_) raw_.normals.reserve(n);
    if (has_packed_) packed_.reserve(n);
    if (has_colors_) wide_.reserve(n);
    return {};
  }

  void push(const Row& row) {
    raw_.positions.push_back(row.position);
    if (has_normals_) raw_.normals.push_back(row.normal);
    if (has_packed_) packed_.push_back(row.packed);
    if (has_colors_) wide_.push_back(row.color);
  }

  static void set(Row& row, const PcdField& field, const char* from) {
    if (field.role == PcdRole::rgb || field.role == PcdRole::rgba) {
      row.packed = load_number<std::uint32_t, false>(from);
    } else {
      row.set(field.role, number_at(field, from));
    }
  }

  Result<void> read_ascii() {
    // A digit and a blank for each number; the last may end with the file.
    LODESTONE_TRY(reserve(2 * header_.numbers, bytes_.remaining() + 1));
    TextReader text(bytes_, 0, header_.lines + 1);
    for (std::uint64_t i = 0; i < header_.points; ++i) {
      Row row;
      for (const PcdField& field : header_.fields) {
        for (std::uint32_t c = 0; c < field.count; ++c) {
          const std::string_view word = text.word();
          double value = 0;
          if (!parse_number(word, value)) {
            return fail(ErrorCode::bad_format,
                        word.empty() ? fmt::format("the file ends at point {} of {}", i, header_.points)
                                     : fmt::format("'{}' of point {} is not a number", word.substr(0, 40), i),
                        text.place(), "is the file damaged or cut off?");
          }
          if (field.role != PcdRole::rgb && field.role != PcdRole::rgba) {
            row.set(field.role, value);
          } else if (field.type == 'F') {
            row.packed = std::bit_cast<std::uint32_t>(static_cast<float>(value));
          } else {
            const double inside = value > -2147483649.0 && value < 4294967296.0 ? value : 0;
            row.packed = static_cast<std::uint32_t>(static_cast<std::int64_t>(inside));
          }
        }
      }
      push(row);
      if (i % 4096 == 0 && !progress_.go_on(bytes_.position())) return cancelled_error("reading");
    }
    return {};
  }

  Result<void> read_binary() {
    LODESTONE_TRY(reserve(header_.record_bytes, bytes_.remaining()));
    for (std::uint64_t i = 0; i < header_.points; ++i) {
      if (!bytes_.ensure(static_cast<std::size_t>(header_.record_bytes))) return cut_off(i);
      Row row;
      for (const PcdField& field : used_) set(row, field, bytes_.data() + field.offset);
      push(row);
      bytes_.skip(static_cast<std::size_t>(header_.record_bytes));
      if (i % 4096 == 0 && !progress_.go_on(bytes_.position())) return cancelled_error("reading");
    }
    return {};
  }

  // Two sizes, then all numbers of the first field, of the second, and so on, packed as one block.
  Result<void> read_compressed() {
    if (!bytes_.ensure(8)) return cut_off(0);
    const std::uint64_t packed = load_number<std::uint32_t, false>(bytes_.data()),
                        plain = load_number<std::uint32_t, false>(bytes_.data() + 4);
    bytes_.skip(8);
    constexpr std::uint64_t kMostGain = 88;  // 264 bytes from 3
    const std::string place = byte_place(bytes_.name(), header_.data_begin);
    if (packed > bytes_.remaining() || plain > packed * kMostGain) {
      return fail(
          ErrorCode::bad_format,
          fmt::format("{} packed into {}, the file has {} left", size_text(static_cast<double>(plain)),
                      size_text(static_cast<double>(packed)), size_text(static_cast<double>(bytes_.remaining()))),
          place, "is it cut off?");
    }
    LODESTONE_TRY(reserve(header_.record_bytes, plain));
    if (plain != header_.points * header_.record_bytes) {
      return fail(ErrorCode::bad_format,
                  fmt::format("{} points of {} are {}, the file says {}", header_.points,
                              size_text(static_cast<double>(header_.record_bytes)),
                              counted(header_.points * header_.record_bytes, "byte", "bytes"), plain),
                  place, "is the file damaged?");
    }
    if (plain == 0) return {};
    if (!bytes_.ensure(static_cast<std::size_t>(packed))) return cut_off(0);
    std::vector<char> block(static_cast<std::size_t>(plain));
    if (!unpack_lzf({bytes_.data(), static_cast<std::size_t>(packed)}, block)) {
      return fail(ErrorCode::bad_format, "the packed points are damaged", place, "get the file again");
    }
    for (std::uint64_t i = 0; i < header_.points; ++i) {
      Row row;
      for (const PcdField& field : used_) {
        const std::uint64_t each = std::uint64_t{field.size} * field.count;
        set(row, field, block.data() + field.offset * header_.points + i * each);
      }
      push(row);
      if (i % 65536 == 0 && !progress_.go_on(bytes_.position())) return cancelled_error("reading");
    }
    return {};
  }

  tl::unexpected<Error> cut_off(std::uint64_t point) const {
    return fail(ErrorCode::bad_format, fmt::format("the file ends at point {} of {}", point, header_.points),
                byte_place(bytes_.name(), bytes_.position()), "is it cut off?");
  }

  void finish_colors() {
    if (has_colors_) raw_.colors = bytes_of(wide_);
    if (!has_packed_) return;
    const bool has_alpha = header_.has(PcdRole::rgba) &&
                           std::any_of(packed_.begin(), packed_.end(), [](std::uint32_t c) { return c >> 24 != 0; });
    raw_.colors.reserve(packed_.size());
    for (const std::uint32_t c : packed_) {
      const auto byte = [&](unsigned shift) { return static_cast<std::uint8_t>(c >> shift & 255); };
      raw_.colors.push_back({byte(16), byte(8), byte(0), has_alpha ? byte(24) : std::uint8_t{255}});
    }
  }

  ByteReader bytes_;
  ReadProgress progress_;
  PcdHeader header_;
  std::vector<PcdField> used_;
  bool has_normals_ = false, has_packed_ = false, has_colors_ = false;
  RawPoints raw_;
  std::vector<std::uint32_t> packed_;
  std::vector<std::array<std::uint16_t, 3>> wide_;
};

}  // namespace

Result<PointCloud> read_pcd(ByteReader bytes, const Task& task) { return PcdReader(std::move(bytes), task).read(); }

}  // namespace lodestone::io
