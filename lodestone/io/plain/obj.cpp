#include "lodestone/io/plain/obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "lodestone/base/memory.h"
#include "lodestone/io/plain/obj_faces_detail.h"
#include "lodestone/io/plain/obj_materials_detail.h"
#include "lodestone/io/plain/obj_words_detail.h"
#include "lodestone/io/read_detail.h"
#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

namespace {

// What to take from the lines. Faces before their vertices need two passes: all vertices, then all faces.
enum class Pass { all, vertices, faces };

class ObjReader {
 public:
  ObjReader(ByteReader bytes, const std::filesystem::path* folder, Task task)
      : bytes_(std::move(bytes)), materials_(folder), task_(std::move(task)) {}

  Result<Model> read() {
    LODESTONE_TRY(check_encoding());
    {
      ReadProgress progress(task_.part(kReadingShare), bytes_.size());
      Result<void> done = read_lines(Pass::all, progress);
      if (!done && faces_.names_later_vertex()) {
        faces_.clear();
        materials_.clear();
        data_.clear();
        ignored_.clear();
        done = read_lines(Pass::vertices, progress);
        if (done) done = read_lines(Pass::faces, progress);
      }
      LODESTONE_TRY(done);
    }
    LODESTONE_TRY(bytes_.status());
    return finish_model(assemble(), bytes_.name(), 1, task_.part(1 - kReadingShare));
  }

 private:
  Result<void> check_encoding() {
    bytes_.ensure(static_cast<std::size_t>(std::min<std::uint64_t>(bytes_.size(), 1024)));
    std::string_view head(bytes_.data(), std::min<std::size_t>(bytes_.available(), 1024));
    if (head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff")) {
      return fail(ErrorCode::unsupported, "is UTF-16 text", bytes_.name(), "save it as UTF-8 or ASCII");
    }
    if (head.find('\0') != std::string_view::npos) {
      return fail(ErrorCode::bad_format, "is not text: it has a zero byte near its beginning", bytes_.name(),
                  "is it an OBJ file?");
    }
    if (head.starts_with("\xef\xbb\xbf")) text_begin_ = 3;
    return {};
  }

  Result<void> read_lines(Pass pass, ReadProgress& progress) {
    bytes_.seek(text_begin_);
    TextReader text(bytes_);
    text_ = &text;
    pass_ = pass;
    faces_.begin(pass == Pass::faces);
    std::string joined;
    std::string_view line;
    for (std::uint64_t i = 0; text.next_line(line); ++i) {
      if (line.ends_with('\\')) {  // goes on in the next line
        joined.clear();
        bool more = true;
        while (more) {
          more = line.ends_with('\\');
          joined.append(more ? line.substr(0, line.size() - 1) : line);
          joined += ' ';
          if (more && !text.next_line(line)) break;
        }
        line = joined;
      }
      LODESTONE_TRY(take_line(line));
      if (i % 8192 == 0 && !progress.go_on(bytes_.position())) return cancelled_error("reading");
    }
    return {};
  }

  Result<void> take_line(std::string_view line) {
    WordScanner scanner(line);
    const std::string_view key = scanner.word();
    if (key.empty() || key.front() == '#') return {};
    if (key == "v") return take_position(scanner);
    if (key == "vt") return take_uv(scanner);
    if (key == "vn") return take_normal(scanner);
    if (key == "f" || key == "fo") return take_face(scanner);
    if (pass_ == Pass::vertices) return {};
    if (key == "o") {
      materials_.set_object(trimmed(scanner.rest()));
    } else if (key == "g") {
      materials_.set_name(trimmed(scanner.rest()));
    } else if (key == "usemtl") {
      materials_.set_material(trimmed(scanner.rest()));
    } else if (key == "mtllib") {
      materials_.add_library(trimmed(scanner.rest()));
    } else if (key == "l" || key == "p" || key == "curv" || key == "curv2" || key == "surf") {
      ++ignored_[std::string(key)];
    }
    return {};
  }

  Result<void> bad_number(WordScanner& scanner) const {
    const std::string_view word = scanner.word();
    return fail(ErrorCode::bad_format,
                word.empty() ? "a number is missing" : fmt::format("'{}' is not a number", word.substr(0, 40)),
                text_->place(), "is the file damaged or cut off?");
  }

  Result<void> take_position(WordScanner& scanner) {
    ++counts_.positions;
    if (pass_ == Pass::faces) return {};
    if (data_.positions.size() >= kNone - 1) {
      return fail(ErrorCode::unsupported, "more than 4,294,967,294 vertices", text_->place(),
                  "cut the model into parts");
    }
    double v[8];
    std::size_t n = 0;
    while (n < 8 && scanner.number(v[n])) ++n;
    if (n < 3 || (n < 8 && !scanner.at_end())) return bad_number(scanner);
    const std::size_t color_parts = n < 6 ? 0 : n == 7 ? 4 : 3;
    data_.add_color(v + 3, color_parts);
    data_.positions.push_back({v[0], v[1], v[2]});
    return {};
  }

  Result<void> take_uv(WordScanner& scanner) {
    ++counts_.uvs;
    if (pass_ == Pass::faces) return {};
    float v[2] = {0, 0};
    if (!scanner.number(v[0])) return bad_number(scanner);
    if (!scanner.number(v[1]) && !scanner.at_end()) return bad_number(scanner);
    data_.uvs.push_back({v[0], v[1]});
    return {};
  }

  Result<void> take_normal(WordScanner& scanner) {
    ++counts_.normals;
    if (pass_ == Pass::faces) return {};
    Vec3f n;
    if (!scanner.number(n.x) || !scanner.number(n.y) || !scanner.number(n.z)) return bad_number(scanner);
    data_.normals.push_back(n);
    return {};
  }

  Result<void> take_face(WordScanner& scanner) {
    if (pass_ == Pass::vertices) return {};
    return faces_.take(scanner, data_, counts_, materials_.group(), [&] { return text_->place(); });
  }

  Model assemble() {
    Model model = make_model(Mesh{});
    model.file_vertices = data_.positions.size();
    Mesh& mesh = model.meshes[0];
    faces_.fill(mesh, model, data_);  // streams first: they free what they were made from
    set_positions(mesh, data_.positions);
    free_memory(data_.positions);
    materials_.fill(model);
    for (const auto& [key, count] : ignored_) {
      model.warnings.push_back(
          fmt::format("{} of kind '{}' left out: only faces are read", counted(count, "element", "elements"), key));
    }
    return model;
  }

  ByteReader bytes_;
  ObjData data_;
  ObjFaces faces_;
  ObjMaterials materials_;
  Task task_;
  ObjCounts counts_;
  std::uint64_t text_begin_ = 0;
  TextReader* text_ = nullptr;
  Pass pass_ = Pass::all;
  std::map<std::string, std::uint64_t> ignored_;
};

}  // namespace

Result<Model> read_obj(const std::filesystem::path& path, Task task) {
  Result<ByteReader> bytes = ByteReader::open(path);
  LODESTONE_TRY(bytes);
  const std::filesystem::path folder = path.parent_path();
  return ObjReader(std::move(*bytes), &folder, std::move(task)).read();
}

Result<Model> read_obj(std::span<const std::byte> bytes, std::string_view name, Task task) {
  return ObjReader(ByteReader::over(bytes, std::string(name)), nullptr, std::move(task)).read();
}

}  // namespace lodestone::io
