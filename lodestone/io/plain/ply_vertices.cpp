#include "lodestone/base/text.h"
#include "lodestone/io/plain/ply_vertices_detail.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

namespace lodestone::io {

namespace {

bool is_float(ComponentType type) { return type == ComponentType::float32 || type == ComponentType::float64; }
bool is_wide_integer(ComponentType type) { return type == ComponentType::int32 || type == ComponentType::uint32; }

// Names that tell that a number is a label and not a quantity.
bool names_a_label(std::string_view name) {
  const std::string lower = lower_case(name);
  for (const std::string_view word : {"label", "class", "segment", "category", "material", "region", "cluster",
                                      "object", "instance", "group", "part", "flag", "index"}) {
    if (lower.find(word) != std::string::npos) return true;
  }
  return lower == "id" || lower == "ids" || lower.ends_with("_id") || lower.ends_with("id_") || lower.ends_with("_ids");
}

struct Family {
  Semantic semantic;
  std::initializer_list<std::string_view> names;
};

const std::initializer_list<Family> kFamilies{
    {Semantic::normal, {"nx", "ny", "nz"}},
    {Semantic::normal, {"normal_x", "normal_y", "normal_z"}},
    {Semantic::color, {"red", "green", "blue", "alpha"}},
    {Semantic::color, {"red", "green", "blue"}},
    {Semantic::color, {"r", "g", "b", "a"}},
    {Semantic::color, {"r", "g", "b"}},
    {Semantic::color, {"diffuse_red", "diffuse_green", "diffuse_blue"}},
    {Semantic::uv, {"s", "t"}},
    {Semantic::uv, {"u", "v"}},
    {Semantic::uv, {"texture_u", "texture_v"}},
    {Semantic::uv, {"texture_s", "texture_t"}},
    {Semantic::uv, {"s1", "t1"}},
    {Semantic::uv, {"s2", "t2"}},
    {Semantic::uv, {"s3", "t3"}},
    {Semantic::tangent, {"tx", "ty", "tz", "tw"}},
};

// The family's properties, or none if one is missing, taken, a list, or of another type.
std::vector<std::size_t> members_of(const Family& family, const PlyElement& element, const std::vector<bool>& taken) {
  std::vector<std::size_t> members;
  for (const std::string_view name : family.names) {
    const int at = element.find(name);
    if (at < 0) return {};
    const auto i = static_cast<std::size_t>(at);
    const PlyProperty& p = element.properties[i];
    if (taken[i] || p.is_list) return {};
    if (!members.empty() && p.type != element.properties[members[0]].type) return {};
    members.push_back(i);
  }
  const bool needs_float = family.semantic != Semantic::color;
  if (needs_float && !is_float(element.properties[members[0]].type)) return {};
  return members;
}

bool is_position(const PlyProperty& p) { return p.name == "x" || p.name == "y" || p.name == "z"; }

}  // namespace

std::vector<PlyStream> ply_streams(const PlyElement& element) {
  std::vector<PlyStream> streams;
  std::vector<bool> taken(element.properties.size(), false);
  std::array<std::uint32_t, 16> sets{};  // by semantic: streams so far
  for (const Family& family : kFamilies) {
    std::vector<std::size_t> members = members_of(family, element, taken);
    if (members.empty()) continue;
    PlyStream stream;
    stream.semantic = family.semantic;
    stream.set = sets[static_cast<std::size_t>(family.semantic)]++;
    stream.type = element.properties[members[0]].type;
    stream.normalized = !is_float(stream.type);
    // Whole numbers of 32 bits as colours are 0 to 255 as well, in files that know no smaller ones.
    if (is_wide_integer(stream.type)) stream.type = ComponentType::uint8;
    for (const std::size_t i : members) {
      taken[i] = true;
      if (!stream.name.empty()) stream.name += ' ';
      stream.name += element.properties[i].name;
    }
    stream.properties = std::move(members);
    streams.push_back(std::move(stream));
  }
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& p = element.properties[i];
    if (taken[i] || p.is_list || is_position(p)) continue;
    PlyStream stream;
    stream.name = p.name;
    stream.type = p.type;
    if (!is_float(p.type) && names_a_label(p.name)) stream.semantic = Semantic::categorical;
    stream.properties = {i};
    streams.push_back(std::move(stream));
  }
  return streams;
}

namespace {

// Where the values of one property go: every `stride`-th number from `into` on, one a record.
struct Column {
  enum class Kind { floats, doubles, words } kind = Kind::floats;
  ComponentType type = ComponentType::float32;
  std::size_t record_offset = 0;  // binary records without lists
  void* into = nullptr;           // null: nowhere
  std::size_t stride = 1;
  double divisor = 0;  // of normalised integers

  void store(std::size_t row, double value) const {
    if (into == nullptr) return;
    if (kind == Kind::words) {
      const double lowest = type == ComponentType::uint32 ? 0.0 : -2147483648.0, highest = 4294967295.0;
      const double inside = value >= lowest ? std::min(value, highest) : value < lowest ? lowest : 0.0;
      static_cast<std::uint32_t*>(into)[row * stride] = static_cast<std::uint32_t>(static_cast<std::int64_t>(inside));
      return;
    }
    if (divisor > 0) value = std::max(value / divisor, -1.0);
    if (kind == Kind::floats) {
      static_cast<float*>(into)[row * stride] = static_cast<float>(value);
    } else {
      static_cast<double*>(into)[row * stride] = value;
    }
  }
  bool is_plain_float() const {
    return kind == Kind::floats && type == ComponentType::float32 && divisor == 0 && into != nullptr;
  }
};

double divisor_of(ComponentType type) {
  switch (type) {
    case ComponentType::int8:
      return 127;
    case ComponentType::int16:
      return 32767;
    case ComponentType::uint16:
      return 65535;
    default:
      return 255;
  }
}

void bind(Column& column, AttributeStream& stream, std::size_t component) {
  column.stride = stream.components;
  if (auto* floats = std::get_if<std::vector<float>>(&stream.values)) {
    column.kind = Column::Kind::floats;
    column.into = floats->data() + component;
  } else if (auto* doubles = std::get_if<std::vector<double>>(&stream.values)) {
    column.kind = Column::Kind::doubles;
    column.into = doubles->data() + component;
  } else {
    column.kind = Column::Kind::words;
    column.into = std::get<std::vector<std::uint32_t>>(stream.values).data() + component;
  }
  if (stream.normalized) column.divisor = divisor_of(stream.type);
}

class VertexReader {
 public:
  VertexReader(PlyValues& values, const PlyElement& element, Model& model, ReadProgress& progress)
      : values_(values), element_(element), model_(model), mesh_(model.meshes[0]), progress_(progress) {}

  Result<void> read() {
    LODESTONE_TRY(plan());
    Result<void> done;
    if (values_.is_text() || element_.has_lists()) {
      done = read_one_by_one();
    } else if (is_bare()) {
      done = read_bare();
    } else {
      done = read_columns();
    }
    if (!done) return done;
    if (!wide_.empty()) set_positions(mesh_, wide_);
    return {};
  }

 private:
  Result<void> plan() {
    const std::string place = line_place(values_.bytes().name(), element_.line);
    if (element_.count >= kNone) {
      return fail(ErrorCode::unsupported,
                  fmt::format("{} vertices are more than 4,294,967,294", count_text(element_.count)), place,
                  "cut the model into parts");
    }
    const auto count = static_cast<std::size_t>(element_.count);
    columns_.resize(element_.properties.size());
    std::size_t offset = 0;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const PlyProperty& p = element_.properties[i];
      columns_[i].type = p.type;
      columns_[i].record_offset = offset;
      offset += size_of(p.type);
      if (p.is_list) {
        model_.warnings.push_back(fmt::format("the list '{}' of vertices was left out", p.name));
      }
    }
    record_bytes_ = offset;
    LODESTONE_TRY(plan_positions(count, place));
    for (const PlyStream& s : ply_streams(element_)) {
      AttributeStream stream =
          make_stream(s.name, s.semantic, static_cast<std::uint32_t>(s.properties.size()), s.type, s.normalized, count);
      stream.set = s.set;
      mesh_.attributes.push_back(std::move(stream));
      if (count == 0) continue;  // nothing to point at
      for (std::size_t c = 0; c < s.properties.size(); ++c) {
        bind(columns_[s.properties[c]], mesh_.attributes.back(), c);
      }
    }
    return {};
  }

  Result<void> plan_positions(std::size_t count, const std::string& place) {
    std::array<std::size_t, 3> at{};
    bool wide = false;
    constexpr std::array<std::string_view, 3> kNames{"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int found = element_.find(kNames[axis]);
      if (found < 0 || element_.properties[static_cast<std::size_t>(found)].is_list) {
        return fail(ErrorCode::bad_format, fmt::format("the vertices have no property '{}'", kNames[axis]), place);
      }
      at[axis] = static_cast<std::size_t>(found);
      const ComponentType type = element_.properties[at[axis]].type;
      wide = wide || type == ComponentType::float64 || is_wide_integer(type);
    }
    if (wide) {
      wide_.resize(count);
    } else {
      mesh_.positions.resize(count);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Column& column = columns_[at[axis]];
      column.stride = 3;
      column.kind = wide ? Column::Kind::doubles : Column::Kind::floats;
      if (count == 0) continue;
      column.into = wide ? static_cast<void*>(&wide_[0][axis]) : static_cast<void*>(&mesh_.positions[0][axis]);
    }
    return {};
  }

  // Nothing but x, y, z as little-endian floats: the file's bytes are the array.
  bool is_bare() const {
    return !values_.is_swapped() && record_bytes_ == 12 && element_.properties.size() == 3 && wide_.empty() &&
           element_.properties[0].name == "x" && element_.properties[1].name == "y" &&
           element_.properties[2].name == "z" && columns_[0].is_plain_float() && columns_[1].is_plain_float() &&
           columns_[2].is_plain_float();
  }

  Result<void> read_bare() {
    constexpr std::size_t kBlock = std::size_t{1} << 18;  // vertices
    for (std::size_t begin = 0; begin < mesh_.positions.size(); begin += kBlock) {
      const std::size_t n = std::min(kBlock, mesh_.positions.size() - begin);
      const std::size_t got =
          values_.bytes().read(std::as_writable_bytes(std::span(mesh_.positions).subspan(begin, n)));
      if (got < n * sizeof(Vec3f)) return cut_off(begin + got / sizeof(Vec3f));
      if (!progress_.go_on(values_.bytes().position())) return cancelled_error("reading");
    }
    return {};
  }

  // Records of one size: many at a time, property by property.
  Result<void> read_columns() {
    ByteReader& bytes = values_.bytes();
    const auto count = static_cast<std::size_t>(element_.count);
    for (std::size_t row = 0; row < count;) {
      if (!bytes.ensure(record_bytes_)) return cut_off(row);
      constexpr std::size_t kMost = 2048;  // so that a block stays in the nearest cache
      const std::size_t n = std::min({bytes.available() / std::max<std::size_t>(1, record_bytes_), count - row, kMost});
      for (const Column& column : columns_) copy_column(column, bytes.data() + column.record_offset, row, n);
      bytes.skip(n * record_bytes_);
      row += n;
      if (!progress_.go_on(bytes.position())) return cancelled_error("reading");
    }
    return {};
  }

  void copy_column(const Column& column, const char* from, std::size_t row, std::size_t n) const {
    if (column.is_plain_float() && !values_.is_swapped()) {
      float* into = static_cast<float*>(column.into) + row * column.stride;
      for (std::size_t i = 0; i < n; ++i) {
        into[i * column.stride] = load_number<float, false>(from + i * record_bytes_);
      }
      return;
    }
    with_type(column.type, [&](auto zero) {
      using T = decltype(zero);
      for (std::size_t i = 0; i < n; ++i) {
        const char* at = from + i * record_bytes_;
        const T value = values_.is_swapped() ? load_number<T, true>(at) : load_number<T, false>(at);
        column.store(row + i, static_cast<double>(value));
      }
    });
  }

  Result<void> read_one_by_one() {
    const auto count = static_cast<std::size_t>(element_.count);
    for (std::size_t row = 0; row < count; ++row) {
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        const PlyProperty& p = element_.properties[i];
        double value = 0;
        if (p.is_list ? !values_.skip(p) : !values_.next(p.type, value)) return cut_off(row);
        if (!p.is_list) columns_[i].store(row, value);
      }
      if (row % 4096 == 0 && !progress_.go_on(values_.bytes().position())) return cancelled_error("reading");
    }
    return {};
  }

  Result<void> cut_off(std::size_t row) const {
    return fail(values_.error(fmt::format("vertex {} of {}", row, element_.count)));
  }

  PlyValues& values_;
  const PlyElement& element_;
  Model& model_;
  Mesh& mesh_;
  ReadProgress& progress_;
  std::vector<Column> columns_;  // one a property
  std::vector<Vec3d> wide_;      // positions, where floats may not hold them
  std::size_t record_bytes_ = 0;
};

}  // namespace

Result<void> read_ply_vertices(PlyValues& values, const PlyElement& element, Model& model, ReadProgress& progress) {
  return VertexReader(values, element, model, progress).read();
}

}  // namespace lodestone::io
