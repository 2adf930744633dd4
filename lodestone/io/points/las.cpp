#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "lodestone/io/plain/ply_values_detail.h"
#include "lodestone/io/points/read_detail.h"
#include "lodestone/io/points/wide_colors_detail.h"
#include "lodestone/io/read_detail.h"

namespace lodestone::io {

namespace {

// ASPRS LAS 1.0 to 1.4: bytes of a point record of each format, and where its colour is (0: it has none).
struct PointFormat {
  std::uint16_t bytes;
  std::uint16_t color;
};
constexpr std::array<PointFormat, 11> kPointFormats{
    {{20, 0}, {28, 0}, {26, 20}, {34, 28}, {57, 0}, {63, 28}, {30, 0}, {36, 30}, {38, 30}, {59, 0}, {67, 30}}};

struct LasHeader {
  unsigned minor = 0;
  std::uint64_t points_begin = 0;
  std::uint64_t points = 0;
  unsigned format = 0;
  std::uint64_t record_bytes = 0;
  Vec3d scale, offset;
};

class LasReader {
 public:
  LasReader(ByteReader bytes, const Task& task) : bytes_(std::move(bytes)), progress_(task, bytes_.size()) {}

  Result<PointCloud> read() {
    LODESTONE_TRY(read_header());
    LODESTONE_TRY(read_records());
    LODESTONE_TRY(bytes_.status());
    raw_.colors = bytes_of(colors_);
    return finish_points(std::move(raw_), bytes_.name());
  }

 private:
  tl::unexpected<Error> bad(std::string what, std::uint64_t byte, std::string remedy = "is the file damaged?") const {
    return fail(ErrorCode::bad_format, std::move(what), byte_place(bytes_.name(), byte), std::move(remedy));
  }

  template <class T>
  T at(std::size_t byte) const {
    return load_number<T, false>(bytes_.data() + byte);
  }

  Result<void> read_header() {
    constexpr std::size_t kHeader = 227, kHeader14 = 375;
    if (!bytes_.ensure(4) || std::memcmp(bytes_.data(), "LASF", 4) != 0) {
      return bad("does not begin with 'LASF'", 0, "is it a LAS file?");
    }
    if (!bytes_.ensure(kHeader)) {
      return bad(fmt::format("has {}, a header needs {}", size_text(static_cast<double>(bytes_.size())), kHeader), 0,
                 "is it cut off?");
    }
    const unsigned major = at<std::uint8_t>(24);
    header_.minor = at<std::uint8_t>(25);
    if (major != 1 || header_.minor > 4) {
      return fail(ErrorCode::unsupported, fmt::format("is LAS {}.{}", major, header_.minor),
                  byte_place(bytes_.name(), 24), "save it as 1.0 to 1.4");
    }
    const std::uint64_t header_bytes = at<std::uint16_t>(94);
    header_.points_begin = at<std::uint32_t>(96);
    const unsigned format = at<std::uint8_t>(104);
    header_.record_bytes = at<std::uint16_t>(105);
    header_.points = at<std::uint32_t>(107);
    for (std::size_t k = 0; k < 3; ++k) {
      header_.scale[k] = at<double>(131 + 8 * k);
      header_.offset[k] = at<double>(155 + 8 * k);
    }
    if (header_.minor == 4 && header_bytes >= kHeader14 && bytes_.ensure(kHeader14) && at<std::uint64_t>(247) > 0) {
      header_.points = at<std::uint64_t>(247);
    }
    if ((format & 0xC0) != 0) {
      return fail(ErrorCode::unsupported, "is compressed (LAZ)", bytes_.name(),
                  "convert it first: pdal translate in.laz out.las");
    }
    header_.format = format;
    return check_header();
  }

  Result<void> check_header() {
    if (header_.format >= kPointFormats.size()) {
      return fail(ErrorCode::unsupported, fmt::format("has points of format {}", header_.format),
                  byte_place(bytes_.name(), 104), "save it with format 0 to 10");
    }
    const PointFormat& format = kPointFormats[header_.format];
    if (header_.record_bytes < format.bytes) {
      return bad(fmt::format("points of format {} have {} bytes, the file says {}", header_.format, format.bytes,
                             header_.record_bytes),
                 105);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::isfinite(header_.scale[k]) && header_.scale[k] != 0 && std::isfinite(header_.offset[k])) continue;
      return bad(fmt::format("scale {} and offset {} make no coordinates", header_.scale[k], header_.offset[k]), 131);
    }
    if (header_.points_begin > bytes_.size()) {
      return bad(fmt::format("points begin at byte {}, the file has {}", header_.points_begin, bytes_.size()), 96,
                 "is it cut off?");
    }
    const std::uint64_t room = (bytes_.size() - header_.points_begin) / header_.record_bytes;
    if (header_.points > room) {
      return bad(fmt::format("the header tells of {} points of {} bytes, the file has room for {}",
                             count_text(header_.points), header_.record_bytes, count_text(room)),
                 107, "is it cut off?");
    }
    if (header_.points >= kNone) return too_many_points(header_.points, bytes_.name());
    return {};
  }

  Result<void> read_records() {
    bytes_.seek(header_.points_begin);
    const std::size_t color = kPointFormats[header_.format].color;
    const auto count = static_cast<std::size_t>(header_.points);
    const auto record = static_cast<std::size_t>(header_.record_bytes);
    raw_.positions.reserve(count);
    if (color > 0) colors_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      if (!bytes_.ensure(record)) {
        return bad(fmt::format("the file ends at point {} of {}", i, count), bytes_.position(), "is it cut off?");
      }
      Vec3d p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = at<std::int32_t>(4 * k) * header_.scale[k] + header_.offset[k];
      raw_.positions.push_back(p);
      if (color > 0) {
        colors_.push_back({at<std::uint16_t>(color), at<std::uint16_t>(color + 2), at<std::uint16_t>(color + 4)});
      }
      bytes_.skip(record);
      if (i % 4096 == 0 && !progress_.go_on(bytes_.position())) return cancelled_error("reading");
    }
    return {};
  }

  ByteReader bytes_;
  ReadProgress progress_;
  LasHeader header_;
  RawPoints raw_;
  std::vector<std::array<std::uint16_t, 3>> colors_;
};

}  // namespace

Result<PointCloud> read_las(ByteReader bytes, const Task& task) { return LasReader(std::move(bytes), task).read(); }

}  // namespace lodestone::io
