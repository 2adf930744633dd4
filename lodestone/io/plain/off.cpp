#include "lodestone/io/plain/off.h"

#include <fmt/format.h>

#include <algorithm>

#include "lodestone/io/plain/color_range_detail.h"
#include "lodestone/io/plain/polygon.h"
#include "lodestone/io/read_detail.h"
#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

namespace {

class OffReader {
 public:
  OffReader(ByteReader bytes, Task task)
      : bytes_(std::move(bytes)),
        text_(bytes_, '#'),
        task_(std::move(task)),
        model_(make_model(Mesh{})),
        mesh_(model_.meshes[0]) {}

  Result<Model> read() {
    {
      ReadProgress progress(task_.part(kReadingShare), bytes_.size());
      Result<void> done = read_header();
      if (done) done = read_vertices(progress);
      if (done) done = read_faces(progress);
      LODESTONE_TRY(done);
    }
    LODESTONE_TRY(bytes_.status());
    return finish_model(std::move(model_), bytes_.name(), 0, task_.part(1 - kReadingShare));
  }

 private:
  tl::unexpected<Error> bad(std::string what, std::string remedy = "is the file damaged or cut off?") const {
    return fail(ErrorCode::bad_format, std::move(what), text_.place(), std::move(remedy));
  }
  tl::unexpected<Error> bad_word(std::string_view word, std::string_view expected) const {
    return word.empty() ? bad(fmt::format("the file ends where {} should be", expected), "is it cut off?")
                        : bad(fmt::format("'{}' is not {}", word.substr(0, 40), expected));
  }

  // [ST][C][N][4][n]OFF [BINARY], then three counts, of which the first may be joined to the keyword.
  Result<void> read_header() {
    const std::string word(text_.word());
    std::string_view key = word;
    const auto take = [&](std::string_view prefix) {
      if (!key.starts_with(prefix)) return false;
      key.remove_prefix(prefix.size());
      return true;
    };
    has_uv_ = take("ST");
    has_color_ = take("C");
    has_normal_ = take("N");
    const bool other_dimension = take("4") || take("n");
    if (!take("OFF")) return bad("does not begin with 'OFF'", "is it an OFF file?");
    if (other_dimension) {
      return fail(ErrorCode::unsupported, "has vertices of four or more dimensions", text_.place(),
                  "save it with three");
    }
    std::string first(key);
    if (first.empty()) first = text_.word();
    if (first == "BINARY") {
      return fail(ErrorCode::unsupported, "is a binary OFF", text_.place(), "save it as text or as PLY");
    }
    std::int64_t count = 0;
    if (!parse_integer(first, count)) return bad_word(first, "a count of vertices");
    if (count < 0) return bad(fmt::format("vertex count {} is negative", count));
    vertices_ = static_cast<std::uint64_t>(count);
    const std::string_view second = text_.word();
    if (!parse_integer(second, count)) return bad_word(second, "a count of faces");
    if (count < 0) return bad(fmt::format("face count {} is negative", count));
    faces_ = static_cast<std::uint64_t>(count);
    text_.word_on_line();  // the count of edges, which nobody needs and some leave out
    return check_counts();
  }

  Result<void> check_counts() {
    constexpr std::uint64_t kVertexBytes = 6, kFaceBytes = 2;  // "0 0 0\n", "0\n"
    const std::uint64_t left = bytes_.remaining() + 1;
    if (vertices_ > left / kVertexBytes) {
      return count_too_large("vertex", vertices_, kVertexBytes, bytes_.size(), text_.place());
    }
    if (faces_ > (left - vertices_ * kVertexBytes) / kFaceBytes) {
      return count_too_large("face", faces_, kFaceBytes, bytes_.size(), text_.place());
    }
    if (vertices_ >= kNone) {
      return fail(ErrorCode::unsupported, "more than 4,294,967,294 vertices", text_.place(),
                  "cut the model into parts");
    }
    return {};
  }

  // How many numbers a vertex has, from the first one's line if that makes sense, and so how many are its colour. The
  // text stands at the first vertex again afterwards.
  void plan_columns() {
    const std::uint64_t first_bytes = text_.word().size();  // may be lines further down
    const std::uint64_t begin = bytes_.position() - first_bytes;
    std::size_t on_line = 1;
    while (!text_.word_on_line().empty()) ++on_line;
    bytes_.seek(begin);
    const std::size_t without_color = 3 + (has_normal_ ? 3U : 0U) + (has_uv_ ? 2U : 0U);
    const bool plain = !has_color_ && !has_normal_ && !has_uv_;
    if (plain && (on_line == 6 || on_line == 7) && vertices_ > 1) has_color_ = true;
    if (has_color_) color_components_ = on_line == without_color + 3 ? 3 : 4;
    columns_ = without_color + color_components_;
    extra_on_line_ = on_line > columns_ && on_line % columns_ != 0;  // something we don't know follows
  }

  Result<void> read_vertices(ReadProgress& progress) {
    const auto count = static_cast<std::size_t>(vertices_);
    std::vector<Vec3d> positions;
    std::vector<double> numbers;
    positions.reserve(count);
    if (count > 0) plan_columns();
    reserve_streams(count);
    for (std::size_t v = 0; v < count; ++v) {
      numbers.clear();
      while (numbers.size() < columns_) {
        const std::string_view word = text_.word();
        double value = 0;
        if (!parse_number(word, value)) return bad_word(word, fmt::format("a number of vertex {} of {}", v, count));
        numbers.push_back(value);
      }
      if (extra_on_line_) text_.skip_line();
      positions.push_back({numbers[0], numbers[1], numbers[2]});
      const double* next = numbers.data() + 3;
      for (std::size_t i = 0; i < (has_normal_ ? 3U : 0U); ++i) normals_.push_back(static_cast<float>(*next++));
      for (std::size_t i = 0; i < color_components_; ++i) {
        color_range_.add(*next);
        colors_.push_back(static_cast<float>(*next++));
      }
      for (std::size_t i = 0; i < (has_uv_ ? 2U : 0U); ++i) uvs_.push_back(static_cast<float>(*next++));
      if (v % 4096 == 0 && !progress.go_on(bytes_.position())) return cancelled_error("reading");
    }
    model_.file_vertices = count;
    set_positions(mesh_, positions);
    add_streams();
    return {};
  }

  void reserve_streams(std::size_t count) {
    normals_.reserve(has_normal_ ? 3 * count : 0);
    colors_.reserve(color_components_ * count);
    uvs_.reserve(has_uv_ ? 2 * count : 0);
  }

  void add_streams() {
    if (has_normal_) add_stream("NORMAL", Semantic::normal, 3, std::move(normals_));
    if (has_uv_) add_stream("TEXCOORD_0", Semantic::uv, 2, std::move(uvs_));
    if (!has_color_) return;
    for (float& c : colors_) c /= color_range_.divisor();
    add_stream("COLOR_0", Semantic::color, static_cast<std::uint32_t>(color_components_), std::move(colors_));
    if (color_range_.is_bytes()) {
      mesh_.attributes.back().type = ComponentType::uint8;
      mesh_.attributes.back().normalized = true;
    }
  }

  void add_stream(const char* name, Semantic semantic, std::uint32_t components, std::vector<float> values) {
    AttributeStream stream = make_stream(name, semantic, components, ComponentType::float32, false, 0);
    stream.values = std::move(values);
    mesh_.attributes.push_back(std::move(stream));
  }

  Result<void> read_faces(ReadProgress& progress) {
    std::vector<std::uint32_t> corners;
    std::vector<Vec3d> points;
    PolygonCutter cutter;
    std::uint64_t short_faces = 0, colored = 0;
    mesh_.triangles.reserve(static_cast<std::size_t>(std::min(faces_, bytes_.remaining() / 8 + 1)));
    for (std::uint64_t f = 0; f < faces_; ++f) {
      const std::string_view word = text_.word();
      std::int64_t count = 0;
      if (!parse_integer(word, count))
        return bad_word(word, fmt::format("the number of corners of face {} of {}", f, faces_));
      if (count < 0 || static_cast<std::uint64_t>(count) > bytes_.remaining() / 2 + 1) {
        return bad(fmt::format("face {} has {} corners, the file has {} left", f, count,
                               size_text(static_cast<double>(bytes_.remaining()))));
      }
      corners.clear();
      for (std::int64_t i = 0; i < count; ++i) {
        const std::string_view name = text_.word();
        std::int64_t index = 0;
        if (!parse_integer(name, index)) return bad_word(name, fmt::format("a corner of face {} of {}", f, faces_));
        if (index < 0 || static_cast<std::uint64_t>(index) >= vertices_) {
          return bad(fmt::format("face {} names vertex {}, the file has {} (counted from 0)", f, index, vertices_));
        }
        corners.push_back(static_cast<std::uint32_t>(index));
      }
      if (!text_.word_on_line().empty()) {  // a colour
        ++colored;
        text_.skip_line();
      }
      if (corners.size() < 3) {
        ++short_faces;
      } else if (corners.size() == 3) {
        mesh_.triangles.push_back({corners[0], corners[1], corners[2]});
      } else {
        points.clear();
        for (const std::uint32_t v : corners) points.push_back(to_double(mesh_.positions[v]));
        for (const CornerTriple& t : cutter.cut(points)) {
          mesh_.triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
        }
      }
      if (f % 4096 == 0 && !progress.go_on(bytes_.position())) return cancelled_error("reading");
    }
    model_.file_triangles = mesh_.triangles.size();
    if (short_faces > 0) {
      model_.warnings.push_back(
          fmt::format("{} with fewer than 3 corners skipped", counted(short_faces, "face", "faces")));
    }
    if (colored > 0)
      model_.warnings.push_back(fmt::format("colours of {} were left out", counted(colored, "face", "faces")));
    return {};
  }

  ByteReader bytes_;
  TextReader text_;
  Task task_;
  Model model_;
  Mesh& mesh_;
  bool has_uv_ = false, has_color_ = false, has_normal_ = false, extra_on_line_ = false;
  std::uint64_t vertices_ = 0, faces_ = 0;
  std::size_t columns_ = 3, color_components_ = 0;
  ColorRange color_range_;
  std::vector<float> normals_, colors_, uvs_;
};

}  // namespace

Result<Model> read_off(const std::filesystem::path& path, Task task) {
  Result<ByteReader> bytes = ByteReader::open(path);
  LODESTONE_TRY(bytes);
  return OffReader(std::move(*bytes), std::move(task)).read();
}

Result<Model> read_off(std::span<const std::byte> bytes, std::string_view name, Task task) {
  return OffReader(ByteReader::over(bytes, std::string(name)), std::move(task)).read();
}

}  // namespace lodestone::io
