#include "lodestone/io/plain/stl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "lodestone/base/text.h"
#include "lodestone/io/plain/polygon.h"
#include "lodestone/io/plain/position_table_detail.h"
#include "lodestone/io/read_detail.h"
#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

namespace {

constexpr std::uint64_t kHeaderBytes = 84, kTriangleBytes = 50;

class StlReader {
 public:
  StlReader(ByteReader bytes, Task task)
      : bytes_(std::move(bytes)), task_(std::move(task)), model_(make_model(Mesh{})), mesh_(model_.meshes[0]) {}

  Result<Model> read() {
    Result<bool> binary = is_binary();
    LODESTONE_TRY(binary);
    {
      ReadProgress progress(task_.part(kReadingShare), bytes_.size());
      LODESTONE_TRY(*binary ? read_binary(progress) : read_text(progress));
    }
    LODESTONE_TRY(bytes_.status());
    mesh_.positions = std::move(table_.positions);
    table_ = {};
    model_.file_vertices = 3 * model_.file_triangles;
    if (solids_.size() > 1) {
      for (const std::string& name : solids_) mesh_.groups.push_back({kNone, name});
    } else {
      mesh_.face_group.clear();
      if (!solids_.empty()) mesh_.name = solids_[0];
    }
    return finish_model(std::move(model_), bytes_.name(), 0, task_.part(1 - kReadingShare));
  }

 private:
  // Binary if the count fits the size exactly, text if it begins with "solid" and looks like it, else binary if it can
  // be.
  Result<bool> is_binary() {
    bytes_.ensure(static_cast<std::size_t>(std::min<std::uint64_t>(bytes_.size(), 1024)));
    const std::string_view head(bytes_.data(), std::min<std::size_t>(bytes_.available(), 1024));
    const bool has_zero = head.find('\0') != std::string_view::npos;
    const std::string lower = lower_case(head);
    const bool says_solid = trimmed(lower).starts_with("solid");
    if (head.size() >= kHeaderBytes) {
      std::memcpy(&count_, head.data() + 80, 4);
      if (kHeaderBytes + count_ * kTriangleBytes == bytes_.size() && (count_ > 0 || !says_solid || has_zero))
        return true;
    }
    if (says_solid && !has_zero) return false;
    if (head.size() < kHeaderBytes) {
      return fail(
          ErrorCode::bad_format,
          fmt::format("has {} bytes and does not begin with 'solid': a binary STL has at least 84", bytes_.size()),
          bytes_.name(), "is it cut off?");
    }
    return true;
  }

  Result<void> read_binary(ReadProgress& progress) {
    const std::uint64_t holds = (bytes_.size() - kHeaderBytes) / kTriangleBytes;
    if (count_ > holds) {
      return count_too_large("triangle", count_, kTriangleBytes, bytes_.size(), byte_place(bytes_.name(), 80));
    }
    bytes_.skip(kHeaderBytes);
    mesh_.triangles.reserve(count_);
    bool has_attributes = false;
    for (std::uint32_t done = 0; done < count_;) {
      if (!bytes_.ensure(kTriangleBytes)) {
        return fail(ErrorCode::bad_format, fmt::format("the file ends in triangle {} of {}", done, count_),
                    byte_place(bytes_.name(), bytes_.position()), "is it cut off?");
      }
      const auto n = static_cast<std::uint32_t>(
          std::min<std::size_t>({bytes_.available() / kTriangleBytes, count_ - done, std::size_t{8192}}));
      for (std::uint32_t i = 0; i < n; ++i) {
        const char* record = bytes_.data() + i * kTriangleBytes;
        Vec3f corners[3];
        std::memcpy(corners, record + 12, sizeof corners);
        mesh_.triangles.push_back({table_.vertex(corners[0]), table_.vertex(corners[1]), table_.vertex(corners[2])});
        has_attributes = has_attributes || record[48] != 0 || record[49] != 0;
      }
      bytes_.skip(n * kTriangleBytes);
      done += n;
      if (!progress.go_on(bytes_.position())) return cancelled_error("reading");
    }
    model_.file_triangles = count_;
    if (bytes_.remaining() > 0) {
      model_.warnings.push_back(
          fmt::format("{} behind the last triangle were left out", counted(bytes_.remaining(), "byte", "bytes")));
    }
    if (has_attributes) model_.warnings.push_back("the attribute bytes of triangles (colours, perhaps) were left out");
    return {};
  }

  Result<void> read_text(ReadProgress& progress) {
    TextReader text(bytes_);
    std::vector<Vec3d> loop;
    bool in_facet = false, in_solid = false;
    for (std::uint64_t words = 0;; ++words) {
      const std::string word = lower_case(text.word());
      if (word.empty()) break;
      if (word == "solid") {
        in_solid = true;
        std::string name;
        for (std::string_view part = text.word_on_line(); !part.empty(); part = text.word_on_line()) {
          name += (name.empty() ? "" : " ") + std::string(part);
        }
        solids_.push_back(std::move(name));
      } else if (word == "endsolid") {
        in_solid = false;
        text.skip_line();
      } else if (word == "facet") {
        in_facet = true;
        loop.clear();
      } else if (word == "endfacet") {
        in_facet = false;
        add_loop(loop);
      } else if (word == "vertex") {
        Vec3f p;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const std::string_view number = text.word();
          if (!parse_number(number, p[axis])) {
            return fail(ErrorCode::bad_format,
                        number.empty() ? "the file ends in a vertex"
                                       : fmt::format("'{}' is not a coordinate", number.substr(0, 40)),
                        text.place(), "is it damaged or cut off?");
          }
        }
        loop.push_back(to_double(p));
      } else if (float ignored = 0; word != "normal" && word != "outer" && word != "loop" && word != "endloop" &&
                                    !parse_number(word, ignored)) {
        return fail(ErrorCode::bad_format, fmt::format("'{}' is not a keyword of STL", word.substr(0, 40)),
                    text.place(), "is the file damaged?");
      }
      if (words % 8192 == 0 && !progress.go_on(bytes_.position())) return cancelled_error("reading");
    }
    if (in_facet) return fail(ErrorCode::bad_format, "the file ends in a facet", text.place(), "is it cut off?");
    if (in_solid) model_.warnings.push_back("the file ends without 'endsolid': it may be cut off");
    return {};
  }

  // Some write facets with more than three corners.
  void add_loop(const std::vector<Vec3d>& loop) {
    for (const CornerTriple& t : cutter_.cut(loop)) {
      const auto at = [&](std::size_t i) { return table_.vertex(to_float(loop[t[i]])); };
      const std::uint32_t a = at(0), b = at(1), c = at(2);
      mesh_.triangles.push_back({a, b, c});
      mesh_.face_group.push_back(solids_.empty() ? 0 : static_cast<std::uint32_t>(solids_.size() - 1));
      ++model_.file_triangles;
    }
  }

  ByteReader bytes_;
  Task task_;
  Model model_;
  Mesh& mesh_;
  PositionTable table_;
  PolygonCutter cutter_;
  std::vector<std::string> solids_;
  std::uint32_t count_ = 0;  // of a binary header
};

}  // namespace

Result<Model> read_stl(const std::filesystem::path& path, Task task) {
  Result<ByteReader> bytes = ByteReader::open(path);
  LODESTONE_TRY(bytes);
  return StlReader(std::move(*bytes), std::move(task)).read();
}

Result<Model> read_stl(std::span<const std::byte> bytes, std::string_view name, Task task) {
  return StlReader(ByteReader::over(bytes, std::string(name)), std::move(task)).read();
}

}  // namespace lodestone::io
