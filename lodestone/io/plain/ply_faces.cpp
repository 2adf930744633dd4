#include "lodestone/io/plain/ply_faces_detail.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "lodestone/io/plain/polygon.h"
#include "lodestone/io/plain/wedge_table_detail.h"

namespace lodestone::io {

namespace {

// The list of corners: by its name, or the only list there is. -1 without one.
int find_corners(const PlyElement& element) {
  for (const std::string_view name : {"vertex_indices", "vertex_index", "vertex_indexes", "indices"}) {
    const int at = element.find(name);
    if (at >= 0 && element.properties[static_cast<std::size_t>(at)].is_list) return at;
  }
  int found = -1;
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    if (!element.properties[i].is_list) continue;
    if (found >= 0) return -1;
    found = static_cast<int>(i);
  }
  return found;
}

bool is_integer_of_32_bits(ComponentType type) { return type == ComponentType::int32 || type == ComponentType::uint32; }

class FaceReader {
 public:
  FaceReader(PlyValues& values, const PlyElement& element, Model& model, ReadProgress& progress)
      : values_(values), element_(element), model_(model), mesh_(model.meshes[0]), progress_(progress) {}

  Result<void> read_faces() {
    corners_at_ = find_corners(element_);
    if (corners_at_ < 0) {
      model_.warnings.push_back("the faces have no list of vertices: they were left out");
      return skip_all();
    }
    texcoord_at_ = element_.find("texcoord");
    if (texcoord_at_ >= 0 && !element_.properties[static_cast<std::size_t>(texcoord_at_)].is_list) texcoord_at_ = -1;
    if (!mesh_.triangles.empty()) texcoord_at_ = -1;  // strips came before: their triangles name vertices
    warn_of_left_out();
    reserve();
    Result<void> done = is_bare() ? read_bare() : read_all_one_by_one();
    if (!done) return done;
    if (texcoord_at_ >= 0) make_wedges();
    if (short_faces_ > 0) {
      model_.warnings.push_back(
          fmt::format("{} with fewer than 3 corners skipped", counted(short_faces_, "face", "faces")));
    }
    return {};
  }

  Result<void> read_strips() {
    corners_at_ = find_corners(element_);
    if (corners_at_ < 0) return skip_all();
    if (!mesh_.wedge_vertex.empty() && element_.count > 0) {
      return fail(ErrorCode::unsupported, "triangle strips beside faces with texture coordinates",
                  line_place(values_.bytes().name(), element_.line), "save the model with faces only");
    }
    for (face_ = 0; face_ < element_.count; ++face_) {
      for (std::size_t i = 0; i < element_.properties.size(); ++i) {
        const PlyProperty& p = element_.properties[i];
        if (static_cast<int>(i) != corners_at_) {
          if (!values_.skip(p)) return cut_off();
        } else
          LODESTONE_TRY(read_strip(p));
      }
    }
    return {};
  }

 private:
  Result<void> skip_all() {
    for (face_ = 0; face_ < element_.count; ++face_) {
      for (const PlyProperty& p : element_.properties) {
        if (!values_.skip(p)) return cut_off();
      }
      if (face_ % 4096 == 0 && !progress_.go_on(values_.bytes().position())) return cancelled_error("reading");
    }
    return {};
  }

  void warn_of_left_out() {
    std::string names;
    for (std::size_t i = 0; i < element_.properties.size(); ++i) {
      if (static_cast<int>(i) == corners_at_ || static_cast<int>(i) == texcoord_at_) continue;
      names += (names.empty() ? "" : ", ") + element_.properties[i].name;
    }
    if (!names.empty()) model_.warnings.push_back("properties of faces were left out: " + names);
  }

  // As many triangles as the faces make if all have three corners, but never more than the file can hold.
  void reserve() {
    const PlyProperty& list = element_.properties[static_cast<std::size_t>(corners_at_)];
    const std::uint64_t each = values_.is_text() ? 8 : size_of(list.count_type) + 3 * size_of(list.type);
    mesh_.triangles.reserve(static_cast<std::size_t>(mesh_.triangles.size() +
                                                     std::min(element_.count, values_.bytes().remaining() / each + 1)));
  }

  // Nothing but the usual list: one byte for the length, indices of 32 bits.
  bool is_bare() const {
    const PlyProperty& list = element_.properties[0];
    return element_.properties.size() == 1 && !values_.is_text() && size_of(list.count_type) == 1 &&
           is_integer_of_32_bits(list.type);
  }

  Result<void> read_bare() {
    face_ = 0;
    while (face_ < element_.count) {
      const std::uint64_t taken = values_.is_swapped() ? take_triangles<true>() : take_triangles<false>();
      face_ += taken;
      if (face_ < element_.count) {  // something else than a good triangle: the careful way
        LODESTONE_TRY(read_one());
        ++face_;
      }
      if (!progress_.go_on(values_.bytes().position())) return cancelled_error("reading");
    }
    return {};
  }

  // Takes triangles from the window until a face is something else or the window ends.
  template <bool swap>
  std::uint64_t take_triangles() {
    constexpr std::size_t kRecord = 13;
    ByteReader& bytes = values_.bytes();
    if (!bytes.ensure(kRecord)) return 0;
    const auto vertices = static_cast<std::uint32_t>(mesh_.positions.size());
    const auto n =
        static_cast<std::size_t>(std::min<std::uint64_t>(bytes.available() / kRecord, element_.count - face_));
    const std::size_t before = mesh_.triangles.size();
    mesh_.triangles.resize(before + n);
    Triangle* into = mesh_.triangles.data() + before;
    const char* from = bytes.data();
    std::size_t i = 0;
    for (; i < n; ++i, from += kRecord) {
      const std::uint32_t a = load_number<std::uint32_t, swap>(from + 1);
      const std::uint32_t b = load_number<std::uint32_t, swap>(from + 5);
      const std::uint32_t c = load_number<std::uint32_t, swap>(from + 9);
      if (*from != 3 || std::max({a, b, c}) >= vertices) break;
      into[i] = {a, b, c};
    }
    mesh_.triangles.resize(before + i);
    model_.file_triangles += i;
    bytes.skip(i * kRecord);
    return i;
  }

  Result<void> read_all_one_by_one() {
    for (face_ = 0; face_ < element_.count; ++face_) {
      LODESTONE_TRY(read_one());
      if (face_ % 4096 == 0 && !progress_.go_on(values_.bytes().position())) return cancelled_error("reading");
    }
    return {};
  }

  Result<void> read_one() {
    corners_.clear();
    texcoords_.clear();
    for (std::size_t i = 0; i < element_.properties.size(); ++i) {
      const PlyProperty& p = element_.properties[i];
      if (static_cast<int>(i) == corners_at_) {
        LODESTONE_TRY(read_corners(p));
      } else if (static_cast<int>(i) == texcoord_at_) {
        std::uint64_t count = 0;
        if (!values_.next_count(p, count)) return cut_off();
        for (std::uint64_t k = 0; k < count; ++k) {
          double value = 0;
          if (!values_.next(p.type, value)) return cut_off();
          texcoords_.push_back(static_cast<float>(value));
        }
      } else if (!values_.skip(p)) {
        return cut_off();
      }
    }
    if (corners_.size() < 3) {
      ++short_faces_;
      return {};
    }
    add_polygon();
    return {};
  }

  Result<void> read_corners(const PlyProperty& p) {
    std::uint64_t count = 0;
    if (!values_.next_count(p, count)) return cut_off();
    for (std::uint64_t k = 0; k < count; ++k) {
      double value = 0;
      if (!values_.next(p.type, value)) return cut_off();
      if (!is_vertex(value)) return out_of_range(value);
      corners_.push_back(static_cast<std::uint32_t>(value));
    }
    return {};
  }

  bool is_vertex(double value) const {
    return value >= 0 && value < static_cast<double>(mesh_.positions.size()) && value == std::floor(value);
  }

  void add_polygon() {
    model_.file_triangles += corners_.size() - 2;
    if (texcoord_at_ >= 0) {
      const bool has = texcoords_.size() >= 2 * corners_.size();
      for (std::size_t k = 0; k < corners_.size(); ++k) {
        const Vec2f uv = has ? Vec2f{texcoords_[2 * k], texcoords_[2 * k + 1]} : Vec2f{};
        // Remembered by vertex for cutting; named by wedge from here on.
        wedges_.push_back(
            table_.wedge(corners_[k], std::bit_cast<std::uint32_t>(uv.x), std::bit_cast<std::uint32_t>(uv.y)));
      }
    }
    const std::vector<std::uint32_t>& named = texcoord_at_ >= 0 ? wedges_ : corners_;
    if (corners_.size() == 3) {
      mesh_.triangles.push_back({named[0], named[1], named[2]});
    } else {
      points_.clear();
      for (const std::uint32_t v : corners_) points_.push_back(to_double(mesh_.positions[v]));
      for (const CornerTriple& t : cutter_.cut(points_)) {
        mesh_.triangles.push_back({named[t[0]], named[t[1]], named[t[2]]});
      }
    }
    wedges_.clear();
  }

  Result<void> read_strip(const PlyProperty& p) {
    std::uint64_t count = 0;
    if (!values_.next_count(p, count)) return cut_off();
    std::uint32_t a = kNone, b = kNone;
    bool odd = false;
    for (std::uint64_t k = 0; k < count; ++k) {
      double value = 0;
      if (!values_.next(p.type, value)) return cut_off();
      if (value == -1.0 || value == 4294967295.0) {
        a = b = kNone;
        odd = false;
        continue;
      }
      if (!is_vertex(value)) return out_of_range(value);
      const auto c = static_cast<std::uint32_t>(value);
      if (a != kNone) {
        if (a != b && b != c && a != c) {
          mesh_.triangles.push_back(odd ? Triangle{b, a, c} : Triangle{a, b, c});
          ++model_.file_triangles;
        }
        odd = !odd;
      }
      a = b;
      b = c;
      if (k % 4096 == 0 && !progress_.go_on(values_.bytes().position())) return cancelled_error("reading");
    }
    return {};
  }

  // Streams were one value a vertex: now one a wedge, and the texture coordinates beside them.
  void make_wedges() {
    const std::size_t wedges = table_.wedge_vertex.size();
    for (AttributeStream& stream : mesh_.attributes) {
      std::visit(
          [&](auto& values) {
            std::remove_reference_t<decltype(values)> spread(wedges * stream.components);
            for (std::size_t w = 0; w < wedges; ++w) {
              std::copy_n(
                  values.begin() + static_cast<std::ptrdiff_t>(std::size_t{table_.wedge_vertex[w]} * stream.components),
                  stream.components, spread.begin() + static_cast<std::ptrdiff_t>(w * stream.components));
            }
            values = std::move(spread);
          },
          stream.values);
    }
    std::uint32_t set = 0;
    for (const AttributeStream& stream : mesh_.attributes) set += stream.semantic == Semantic::uv ? 1 : 0;
    AttributeStream uv = make_stream(set == 0 ? "s t" : fmt::format("s{} t{}", set, set), Semantic::uv, 2,
                                     ComponentType::float32, false, wedges);
    uv.set = set;
    auto& values = std::get<std::vector<float>>(uv.values);
    for (std::size_t w = 0; w < wedges; ++w) {
      values[2 * w] = std::bit_cast<float>(table_.key_a[w]);
      values[2 * w + 1] = std::bit_cast<float>(table_.key_b[w]);
    }
    mesh_.attributes.push_back(std::move(uv));
    mesh_.wedge_vertex = std::move(table_.wedge_vertex);
  }

  Result<void> cut_off() const {
    return fail(values_.error(fmt::format("{} {} of {}", element_.name, face_, element_.count)));
  }
  Result<void> out_of_range(double value) const {
    return fail(ErrorCode::bad_format,
                fmt::format("{} {} names vertex {}, the file has {} (counted from 0)", element_.name, face_, value,
                            mesh_.positions.size()),
                values_.place(), "is the file damaged?");
  }

  PlyValues& values_;
  const PlyElement& element_;
  Model& model_;
  Mesh& mesh_;
  ReadProgress& progress_;
  int corners_at_ = -1, texcoord_at_ = -1;  // properties
  std::uint64_t face_ = 0, short_faces_ = 0;
  std::vector<std::uint32_t> corners_, wedges_;
  std::vector<float> texcoords_;
  std::vector<Vec3d> points_;
  PolygonCutter cutter_;
  WedgeTable table_;
};

}  // namespace

Result<void> read_ply_faces(PlyValues& values, const PlyElement& element, Model& model, ReadProgress& progress) {
  return FaceReader(values, element, model, progress).read_faces();
}

Result<void> read_ply_strips(PlyValues& values, const PlyElement& element, Model& model, ReadProgress& progress) {
  return FaceReader(values, element, model, progress).read_strips();
}

}  // namespace lodestone::io
