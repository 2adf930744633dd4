// Building the working mesh: which triangles take part, the frame, the order in memory.
#include "lodestone/simplify/collapse_state_detail.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lodestone/base/parallel.h"
#include "lodestone/core/weld.h"

namespace lodestone::simplify::detail {

namespace {

constexpr std::size_t kChunk = std::size_t{1} << 15;

// Degenerate triangles and those that repeat an earlier one in the same direction: they carry no surface of their own.
std::vector<std::uint32_t> find_dropped(const Mesh& mesh, const Task& task) {
  struct Face {
    Triangle v;  // rotated so that the lowest vertex comes first: the direction stays
    std::uint32_t triangle;
  };
  std::vector<std::uint32_t> dropped;
  std::vector<Face> faces;
  // Only triangles that share their lowest vertex with their likeness can be doubled: few meshes need the full sort.
  std::vector<std::uint64_t> keys(mesh.triangles.size());
  parallel_for(mesh.triangles.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) {
      Triangle v = mesh.vertices_of(t);
      std::sort(v.begin(), v.end());
      keys[t] = v[0] == v[1] || v[1] == v[2]
                    ? ~std::uint64_t{0}
                    : (std::uint64_t{v[0]} * 0x9e3779b97f4a7c15ULL) ^ (std::uint64_t{v[1]} * 0xc2b2ae3d27d4eb4fULL) ^
                          (std::uint64_t{v[2]} * 0x165667b19e3779f9ULL);
    }
  });
  // A bit a hash bucket seen once, another seen twice: candidates are those in buckets seen twice.
  const std::size_t buckets = std::max<std::size_t>(64, mesh.triangles.size() * 8);
  std::vector<std::uint64_t> once(buckets / 64 + 1, 0), twice(buckets / 64 + 1, 0);
  const auto bucket_of = [&](std::uint64_t key) {
    return static_cast<std::size_t>((static_cast<unsigned __int128>(key * 0xff51afd7ed558ccdULL) * buckets) >> 64);
  };
  for (const std::uint64_t key : keys) {
    if (key == ~std::uint64_t{0}) continue;
    const std::size_t b = bucket_of(key);
    const std::uint64_t bit = std::uint64_t{1} << (b % 64);
    twice[b / 64] |= once[b / 64] & bit;
    once[b / 64] |= bit;
  }
  for (std::size_t t = 0; t < keys.size(); ++t) {
    if (keys[t] == ~std::uint64_t{0}) {
      dropped.push_back(static_cast<std::uint32_t>(t));
      continue;
    }
    const std::size_t b = bucket_of(keys[t]);
    if ((twice[b / 64] >> (b % 64) & 1) == 0) continue;
    Triangle v = mesh.vertices_of(t);
    std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
    faces.push_back({v, static_cast<std::uint32_t>(t)});
  }
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.v != b.v ? a.v < b.v : a.triangle < b.triangle; });
  for (std::size_t i = 1; i < faces.size(); ++i) {
    if (faces[i].v == faces[i - 1].v) dropped.push_back(faces[i].triangle);
  }
  std::sort(dropped.begin(), dropped.end());
  return dropped;
}

// Interleaves the low 10 bits of x, y and z.
std::uint32_t morton_key(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  const auto spread = [](std::uint32_t v) {
    v = (v | v << 16) & 0x030000ffU;
    v = (v | v << 8) & 0x0300f00fU;
    v = (v | v << 4) & 0x030c30c3U;
    return (v | v << 2) & 0x09249249U;
  };
  return spread(x) | spread(y) << 1 | spread(z) << 2;
}

// Vertices along a Morton curve; ties by index.
std::vector<std::uint32_t> space_filling_order(const Mesh& mesh, const Box3f& box, const Task& task) {
  struct Key {
    std::uint32_t code, vertex;
  };
  std::vector<Key> keys(mesh.vertex_count());
  const Vec3f size = box.size();
  const float longest = std::max({size.x, size.y, size.z});
  const float cells = longest > 0 ? 1023.0F / longest : 0;
  parallel_for(keys.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t v = begin; v < end; ++v) {
      const Vec3f p = (mesh.positions[v] - box.min) * cells;
      const auto cell = [](float c) { return static_cast<std::uint32_t>(std::clamp(c, 0.0F, 1023.0F)); };
      keys[v] = {morton_key(cell(p.x), cell(p.y), cell(p.z)), static_cast<std::uint32_t>(v)};
    }
  });
  parallel_sort(keys, task, [](const Key& a, const Key& b) { return a.code < b.code; });
  std::vector<std::uint32_t> order(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) order[i] = keys[i].vertex;
  return order;
}

// Center of the box; scale = the power of two nearest below the mean edge length, so that areas are near one.
void choose_frame(State& state, const Mesh& mesh, const Box3f& box, const Mat4d& metric) {
  const bool regular = std::isfinite(metric.determinant3()) && metric.determinant3() != 0;
  state.metric = regular ? metric.linear() : Mat4d{};
  state.metric_inverse = state.metric.inverse3();
  state.center = to_double(box.min) * 0.5 + to_double(box.max) * 0.5;
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle v = mesh.vertices_of(t);
    sum += length(state.metric.direction(to_double(mesh.positions[v[0]]) - to_double(mesh.positions[v[1]])));
  }
  const double mean = sum / static_cast<double>(std::max<std::size_t>(1, mesh.triangles.size()));
  int exponent = 0;
  std::frexp(mean > 0 ? mean : 1.0, &exponent);
  state.scale = std::ldexp(1.0, exponent - 1);
}

void take_wedges(State& state, const Mesh& mesh, const Task& task) {
  if (mesh.wedge_vertex.empty() && mesh.attributes.empty()) return;
  state.wedges.reserve(state.triangles.size());
  std::vector<bool> compared(mesh.attributes.size());
  for (std::size_t i = 0; i < mesh.attributes.size(); ++i) {
    const AttributeStream& stream = mesh.attributes[i];
    const bool shading = stream.semantic == Semantic::normal || stream.semantic == Semantic::tangent ||
                         stream.semantic == Semantic::morph_normal || stream.semantic == Semantic::morph_tangent;
    compared[i] = !shading;
    const auto* floats = std::get_if<std::vector<float>>(&stream.values);
    if (stream.semantic != Semantic::normal || stream.components != 3 || floats == nullptr) continue;
    state.wedge_normals.resize(mesh.wedge_count());
    for (std::size_t w = 0; w < mesh.wedge_count(); ++w) {
      state.wedge_normals[w] = {(*floats)[w * 3], (*floats)[w * 3 + 1], (*floats)[w * 3 + 2]};
    }
  }
  state.chart = wedge_classes(mesh, compared, task);
}

}  // namespace

Result<State> make_state(const Mesh& mesh, const EdgeCollapseOptions& options, const Task& task) {
  State state;
  state.dropped = find_dropped(mesh, task);
  Box3f box;
  for (const Vec3f p : mesh.positions) box.add(p);
  if (box.empty()) box.add(Vec3f{});
  choose_frame(state, mesh, box, options.metric);
  state.original = space_filling_order(mesh, box, task);
  if (task.cancelled()) return cancelled_error("edge collapse");

  const std::size_t n = mesh.vertex_count();
  std::vector<std::uint32_t> place(n);
  state.positions.resize(n);
  const double inverse = 1 / state.scale;
  parallel_for(n, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t v = state.original[i];
      place[v] = static_cast<std::uint32_t>(i);
      state.positions[i] = to_float(state.metric.direction(to_double(mesh.positions[v]) - state.center) * inverse);
    }
  });
  const bool knows_wedges = !mesh.wedge_vertex.empty() || !mesh.attributes.empty();
  const bool knows_groups = !mesh.face_group.empty();
  state.triangles.reserve(mesh.triangles.size() - state.dropped.size());
  take_wedges(state, mesh, task);
  auto next_dropped = state.dropped.begin();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (next_dropped != state.dropped.end() && *next_dropped == t) {
      ++next_dropped;
      continue;
    }
    const Triangle v = mesh.vertices_of(t);
    state.triangles.push_back({place[v[0]], place[v[1]], place[v[2]]});
    if (knows_wedges) state.wedges.push_back(mesh.triangles[t]);
    if (knows_groups) state.groups.push_back(mesh.face_group[t]);
  }
  classify_vertices(state, options, task);
  if (task.cancelled()) return cancelled_error("edge collapse");
  return state;
}

void build_stars(State& state, const Task& task) {
  state.star_first.assign(state.positions.size() + 1, 0);
  for (const Triangle& t : state.triangles) {
    for (const std::uint32_t v : t) ++state.star_first[v];
  }
  state.star.resize(exclusive_scan(state.star_first, task));
  for (std::uint32_t t = 0; t < state.triangles.size(); ++t) {
    for (const std::uint32_t v : state.triangles[t]) state.star[state.star_first[v]++] = t;
  }
  for (std::size_t v = state.positions.size(); v > 0; --v) state.star_first[v] = state.star_first[v - 1];
  state.star_first[0] = 0;
}

}  // namespace lodestone::simplify::detail
