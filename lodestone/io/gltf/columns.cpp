#include "lodestone/io/gltf/columns_detail.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "lodestone/math/triangle.h"

namespace lodestone::io {

GroupIndexer::GroupIndexer(const Mesh& mesh) : mesh_(mesh), place_(mesh.wedge_count(), kNone) {
  if (mesh.face_group.empty()) return;
  std::uint32_t groups = 0;
  for (const std::uint32_t g : mesh.face_group) groups = std::max(groups, g + 1);
  first_.assign(groups + 1, 0);
  for (const std::uint32_t g : mesh.face_group) ++first_[g + 1];
  for (std::size_t g = 0; g < groups; ++g) first_[g + 1] += first_[g];
  order_.resize(mesh.triangles.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t t = 0; t < order_.size(); ++t) order_[next[mesh.face_group[t]]++] = t;
}

GroupIndex GroupIndexer::of(std::size_t group) {
  GroupIndex out;
  out.group = group;
  const bool sorted = !order_.empty();
  if (sorted ? group + 1 >= first_.size() : group > 0) return out;
  const std::size_t begin = sorted ? first_[group] : 0;
  const std::size_t end = sorted ? first_[group + 1] : mesh_.triangles.size();
  out.corners.reserve((end - begin) * 3);
  for (std::size_t i = begin; i < end; ++i) {
    for (const std::uint32_t w : mesh_.triangles[sorted ? order_[i] : i]) {
      out.corners.push_back(w);
      if (place_[w] != kNone) continue;
      place_[w] = 0;
      out.wedges.push_back(w);
    }
  }
  if (out.wedges.size() > place_.size() / 16) {  // collecting them anew in order is faster than sorting
    out.wedges.clear();
    for (std::uint32_t w = 0; w < place_.size(); ++w) {
      if (place_[w] != kNone) out.wedges.push_back(w);
    }
  } else {
    std::sort(out.wedges.begin(), out.wedges.end());
  }
  for (std::uint32_t i = 0; i < out.wedges.size(); ++i) place_[out.wedges[i]] = i;
  for (std::uint32_t& c : out.corners) c = place_[c];
  for (const std::uint32_t w : out.wedges) place_[w] = kNone;
  return out;
}

namespace {

constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};

// One element's numbers, whatever they are stored as.
void read_tuple(const AttributeStream& stream, std::uint32_t wedge, double* out) {
  const std::size_t n = stream.components, at = wedge * n;
  if (const auto* floats = std::get_if<std::vector<float>>(&stream.values); floats != nullptr) {
    for (std::size_t k = 0; k < n; ++k) out[k] = static_cast<double>((*floats)[at + k]);
  } else if (const auto* doubles = std::get_if<std::vector<double>>(&stream.values); doubles != nullptr) {
    for (std::size_t k = 0; k < n; ++k) out[k] = (*doubles)[at + k];
  } else {
    const auto& bits = std::get<std::vector<std::uint32_t>>(stream.values);
    const bool is_signed = stream.type == ComponentType::int8 || stream.type == ComponentType::int16 ||
                           stream.type == ComponentType::int32;
    for (std::size_t k = 0; k < n; ++k) {
      out[k] = is_signed ? static_cast<double>(std::bit_cast<std::int32_t>(bits[at + k]))
                         : static_cast<double>(bits[at + k]);
    }
  }
}

template <class T>
void store(char* at, double value) {
  const auto v = static_cast<T>(value);
  std::memcpy(at, &v, sizeof(T));
}

template <class T>
double load(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return static_cast<double>(value);
}

double stored_number(const char* at, ComponentType type) {
  switch (type) {
    case ComponentType::int8:
      return load<std::int8_t>(at);
    case ComponentType::uint8:
      return load<std::uint8_t>(at);
    case ComponentType::int16:
      return load<std::int16_t>(at);
    case ComponentType::uint16:
      return load<std::uint16_t>(at);
    default:
      return load<float>(at);
  }
}

// A wedge's weights in one set, settled together with those of all its sets.
class Weights {
 public:
  Weights(const Mesh& mesh, std::size_t group, const AttributeStream& stream) {
    for (const AttributeStream& s : mesh.attributes) {
      if (s.semantic != Semantic::weights || !s.in_group(group)) continue;
      if (&s == &stream) first_ = total_;
      sets_.push_back(&s);
      total_ += s.components;
    }
  }
  void settle(std::uint32_t wedge, ComponentType type, std::size_t components, double* tuple) {
    all_.resize(total_);
    std::size_t at = 0;
    for (const AttributeStream* s : sets_) {
      read_tuple(*s, wedge, all_.data() + at);
      at += s->components;
    }
    sum_to_one(all_, type);
    for (std::size_t k = 0; k < components; ++k) tuple[k] = all_[first_ + k];
  }

 private:
  std::vector<const AttributeStream*> sets_;
  std::size_t first_ = 0, total_ = 0;
  std::vector<double> all_;
};

void make_valid(const AttributeStream& stream, const AttributePlan& plan, Vec3d face_normal, double* v) {
  if (stream.semantic == Semantic::normal || stream.semantic == Semantic::tangent) {
    const double l = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    const Vec3d spare = face_normal == Vec3d{} ? Vec3d{0, 0, 1} : face_normal;
    for (std::size_t k = 0; k < 3; ++k) v[k] = l > 1e-12 ? v[k] / l : spare[k];
    if (stream.semantic == Semantic::tangent) v[3] = v[3] < 0 ? -1 : 1;
  } else if (stream.semantic == Semantic::color) {
    for (std::size_t k = 0; k < stream.components; ++k) v[k] = std::clamp(v[k], 0.0, 1.0);
  }
  if (plan.flip_v) v[1] = 1 - v[1];
}

// A joint without weight is 0, as the format asks.
void clear_unused_joints(const AttributeStream* weights, std::uint32_t wedge, std::size_t components, double* joints) {
  if (weights == nullptr) return;
  double values[4] = {};
  read_tuple(*weights, wedge, values);
  for (std::size_t k = 0; k < components; ++k) {
    if (!(values[k] > 0)) joints[k] = 0;
  }
}

bool needs_care(const AttributeStream& stream, const AttributePlan& plan) {
  switch (stream.semantic) {
    case Semantic::normal:
    case Semantic::tangent:
    case Semantic::color:
    case Semantic::joints:
    case Semantic::weights:
      return true;
    default:
      return plan.flip_v;
  }
}

}  // namespace

void store_number(char* at, double value, ComponentType type, bool normalized) {
  if (type == ComponentType::float32) {
    constexpr double kMost = static_cast<double>(std::numeric_limits<float>::max());
    return store<float>(at, std::clamp(value, -kMost, kMost));
  }
  const double most = largest_of(type);
  const bool is_signed = type == ComponentType::int8 || type == ComponentType::int16;
  double whole = normalized ? value * most : value;
  const double least = !is_signed ? 0.0 : normalized ? -most : -most - 1;
  whole = std::clamp(whole < 0 ? std::ceil(whole - 0.5) : std::floor(whole + 0.5), least, most);
  switch (type) {
    case ComponentType::int8:
      return store<std::int8_t>(at, whole);
    case ComponentType::uint8:
      return store<std::uint8_t>(at, whole);
    case ComponentType::int16:
      return store<std::int16_t>(at, whole);
    default:
      return store<std::uint16_t>(at, whole);
  }
}

void sum_to_one(std::span<double> weights, ComponentType type) {
  double sum = 0;
  for (const double w : weights) sum += w;
  if (!(sum > 0)) {
    std::fill(weights.begin(), weights.end(), 0.0);
    weights.front() = 1;
    return;
  }
  const double most = largest_of(type);
  std::size_t largest = 0;
  double rounded = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    weights[k] /= sum;
    weights[k] = type == ComponentType::float32 ? static_cast<double>(static_cast<float>(weights[k]))
                                                : std::floor(weights[k] * most + 0.5) / most;
    if (weights[k] > weights[largest]) largest = k;
    rounded += weights[k];
  }
  weights[largest] += 1 - rounded;
}

std::vector<Vec3d> face_normals_of(const Mesh& mesh, const GroupIndex& index) {
  std::vector<Vec3d> normals(index.wedges.size());
  for (std::size_t c = 0; c < index.corners.size(); c += 3) {
    Vec3d p[3];
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = to_double(mesh.positions[mesh.vertex_of(index.wedges[index.corners[c + k]])]);
    }
    const Vec3d n = normalized(scaled_normal(p[0], p[1], p[2]));
    for (std::size_t k = 0; k < 3; ++k) {
      if (normals[index.corners[c + k]] == Vec3d{}) normals[index.corners[c + k]] = n;
    }
  }
  return normals;
}

Column stream_column(const Mesh& mesh, const GroupIndex& index, const AttributePlan& plan,
                     const std::vector<Vec3d>& face_normals) {
  const AttributeStream& stream = mesh.attributes[plan.stream];
  const std::size_t n = stream.components, width = size_of(plan.type);
  Column column;
  column.components = n;
  column.type = plan.type;
  column.normalized = plan.normalized;
  column.stride = (width * n + 3) / 4 * 4;
  column.bytes.assign(index.wedges.size() * column.stride, '\0');
  const auto* floats = std::get_if<std::vector<float>>(&stream.values);
  if (floats != nullptr && plan.type == ComponentType::float32 && !needs_care(stream, plan)) {
    for (std::size_t i = 0; i < index.wedges.size(); ++i) {
      std::memcpy(column.bytes.data() + i * column.stride, floats->data() + index.wedges[i] * n, column.stride);
    }
    return column;
  }
  Weights weights(mesh, index.group, stream);
  const bool is_joints = stream.semantic == Semantic::joints && n <= 4;
  const AttributeStream* paired = is_joints ? find_stream(mesh, Semantic::weights, stream.set) : nullptr;
  if (paired != nullptr && (paired->components != n || !paired->in_group(index.group))) paired = nullptr;
  std::vector<double> tuple(std::max<std::size_t>(4, n));
  for (std::size_t i = 0; i < index.wedges.size(); ++i) {
    const std::uint32_t wedge = index.wedges[i];
    read_tuple(stream, wedge, tuple.data());
    make_valid(stream, plan, face_normals.empty() ? Vec3d{} : face_normals[i], tuple.data());
    if (stream.semantic == Semantic::weights) weights.settle(wedge, plan.type, n, tuple.data());
    clear_unused_joints(paired, wedge, n, tuple.data());
    for (std::size_t k = 0; k < n; ++k) {
      store_number(column.bytes.data() + i * column.stride + k * width, tuple[k], plan.type, plan.normalized);
    }
  }
  return column;
}

namespace {

// False as soon as a position is not one of the type's values.
bool fill_integer_positions(const Mesh& mesh, const GroupIndex& index, Column& column) {
  const std::size_t width = size_of(column.type);
  const float top = static_cast<float>(largest_of(column.type));
  for (std::size_t i = 0; i < index.wedges.size(); ++i) {
    const Vec3f& p = mesh.positions[mesh.vertex_of(index.wedges[i])];
    for (std::size_t k = 0; k < 3; ++k) {
      char* at = column.bytes.data() + i * column.stride + k * width;
      store_number(at, static_cast<double>(p[k]), column.type, column.normalized);
      const float whole = static_cast<float>(stored_number(at, column.type));
      const float read_back = column.normalized ? std::max(whole / top, -1.0F) : whole;
      if (!(read_back == p[k])) return false;
    }
  }
  return true;
}

}  // namespace

Column position_column(const Mesh& mesh, const GroupIndex& index, ComponentType type, bool normalized) {
  Column column;
  if (type != ComponentType::float32 && size_of(type) <= 2) {
    column.type = type;
    column.normalized = normalized;
    column.stride = size_of(type) == 1 ? 4 : 8;
    column.bytes.assign(index.wedges.size() * column.stride, '\0');
    if (fill_integer_positions(mesh, index, column)) return column;
    column = {};
  }
  column.bytes.resize(index.wedges.size() * 12);
  for (std::size_t i = 0; i < index.wedges.size(); ++i) {
    std::memcpy(column.bytes.data() + 12 * i, &mesh.positions[mesh.vertex_of(index.wedges[i])], 12);
  }
  return column;
}

Json describe_column(const Column& column, std::size_t count, bool bounds) {
  Json accessor{{"componentType", gltf_number(column.type)}, {"count", count}, {"type", kTypes[column.components]}};
  if (column.normalized) accessor["normalized"] = true;
  if (!bounds) return accessor;
  const std::size_t n = column.components, width = size_of(column.type);
  std::vector<double> low(n, std::numeric_limits<double>::infinity()), high(n, -low[0]);
  for (std::size_t i = 0; i < column.bytes.size(); i += column.stride) {
    for (std::size_t k = 0; k < n; ++k) {
      const double v = stored_number(column.bytes.data() + i + k * width, column.type);
      low[k] = std::min(low[k], v);
      high[k] = std::max(high[k], v);
    }
  }
  const auto tell = [&](const char* key, const std::vector<double>& values) {
    accessor[key] = Json::array();
    for (const double v : values) {
      if (column.type == ComponentType::float32) {
        accessor[key].push_back(static_cast<float>(v));
      } else {
        accessor[key].push_back(static_cast<int>(v));
      }
    }
  };
  tell("min", low);
  tell("max", high);
  return accessor;
}

}  // namespace lodestone::io
