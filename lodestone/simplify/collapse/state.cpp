// The working mesh of an edge-collapse run: which triangles take part, in what frame, in what order in memory
// (docs/papers/edge-collapse.md, "The working mesh").
//
// make_state():
// 1. choose_frame(): floats about the centre of the box, after the linear map `metric`, scaled by a power of two so
//    that areas are near one.
// 2. space_filling_order(): vertices along a Morton curve, so that neighbours are near in memory.
// 3. take_wedges(): charts, that is classes of wedges that differ in normals and tangents alone, and the normals.
// 4. take_triangles(): the triangles that take part, by their lowest vertices (sort_triangles()). Degenerate ones and
//    those that repeat another in the same direction (mark_doubles()) are dropped. Of two that lie back to back on the
//    same wedges one stands for both (find_backs()): sheets modelled with two faces would be non-manifold everywhere.
// 5. take_attributes() (attributes.cpp) and classify_vertices() (classify.cpp).
// build_stars() lists the triangles around each vertex, here and after every pass.
//
// The input is not changed; what takes no part is listed in State::dropped. Sorts are stable and numbers decide between
// equals: the same for any number of threads. O(n log n) for make_state(), O(n) for build_stars().
#include "lodestone/simplify/collapse/state_detail.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestone/base/parallel.h"
#include "lodestone/core/weld.h"
#include "lodestone/simplify/collapse/attributes_detail.h"

namespace lodestone::simplify::detail {

namespace {

constexpr std::size_t kChunk = std::size_t{1} << 15;

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
      // Not a number, where a box of finite floats is wider than the largest float: any cell will do.
      const auto cell = [](float c) { return c > 0 ? static_cast<std::uint32_t>(std::min(c, 1023.0F)) : 0U; };
      keys[v] = {morton_key(cell(p.x), cell(p.y), cell(p.z)), static_cast<std::uint32_t>(v)};
    }
  });
  parallel_sort(keys, task, [](const Key& a, const Key& b) { return a.code < b.code; });
  std::vector<std::uint32_t> order(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) order[i] = keys[i].vertex;
  return order;
}

// Center of the box; scale = the power of two nearest below the mean edge length, so that areas are near one.
void choose_frame(State& state, const Mesh& mesh, const Box3f& box, const Mat4d& metric, const Task& task) {
  const bool regular = std::isfinite(metric.determinant3()) && metric.determinant3() != 0;
  state.metric = regular ? metric.linear() : Mat4d{};
  state.metric_inverse = state.metric.inverse3();
  state.center = to_double(box.min) * 0.5 + to_double(box.max) * 0.5;
  const double sum = parallel_reduce(
      mesh.triangles.size(), kChunk, task, 0.0,
      [&](std::size_t begin, std::size_t end) {
        double part = 0;
        for (std::size_t t = begin; t < end; ++t) {
          const Triangle v = mesh.vertices_of(t);
          part += length(state.metric.direction(to_double(mesh.positions[v[0]]) - to_double(mesh.positions[v[1]])));
        }
        return part;
      },
      [](double x, double y) { return x + y; });
  const double mean = sum / static_cast<double>(std::max<std::size_t>(1, mesh.triangles.size()));
  int exponent = 0;
  std::frexp(mean > 0 ? mean : 1.0, &exponent);
  state.scale = std::ldexp(1.0, exponent - 1);
}

void take_wedges(State& state, const Mesh& mesh, const Task& task) {
  if (mesh.wedge_vertex.empty() && mesh.attributes.empty()) return;
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
      const Vec3f n{(*floats)[w * 3], (*floats)[w * 3 + 1], (*floats)[w * 3 + 2]};
      const float l = length(n);
      if (l > 0 && std::isfinite(l)) state.wedge_normals[w] = n * (1 / l);
    }
  }
  state.chart = wedge_classes(mesh, compared, task);
}

// Triangles sorted by their lowest vertices; those that carry no surface of their own are marked and come last.
struct TriangleOrder {
  std::vector<std::uint32_t> triangle;  // of the input
  std::vector<std::uint32_t> first;     // for each vertex, where those begin whose lowest it is; one more: the marked
};

TriangleOrder sort_triangles(const std::vector<Triangle>& triangles, std::size_t vertices) {
  TriangleOrder out;
  out.first.assign(vertices + 2, 0);
  // Degenerate ones count as of a vertex past the last.
  const auto lowest = [&](const Triangle& c) {
    const bool degenerate = c[0] == c[1] || c[1] == c[2] || c[2] == c[0];
    return degenerate ? static_cast<std::uint32_t>(vertices) : std::min({c[0], c[1], c[2]});
  };
  for (const Triangle& c : triangles) ++out.first[lowest(c) + 1];
  for (std::size_t v = 0; v <= vertices; ++v) out.first[v + 1] += out.first[v];
  out.triangle.resize(triangles.size());
  std::vector<std::uint32_t> next(out.first.begin(), out.first.end() - 1);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) out.triangle[next[lowest(triangles[t])]++] = t;
  return out;
}

// Marks, with kNone, triangles that repeat an earlier one in the same direction.
void mark_doubles(const std::vector<Triangle>& triangles, TriangleOrder& order, const Task& task) {
  const auto turned = [&](std::uint32_t t) {  // the lowest vertex first: the direction stays
    Triangle c = triangles[t];
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
    return std::pair<std::uint32_t, std::uint32_t>{c[1], c[2]};
  };
  parallel_for(order.first.size() - 2, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto first = order.triangle.begin() + order.first[v], last = order.triangle.begin() + order.first[v + 1];
      if (last - first < 2) continue;
      const auto before = [&](std::uint32_t s, std::uint32_t t) {
        return std::pair(turned(s), s) < std::pair(turned(t), t);
      };
      std::sort(first, last, before);
      std::uint32_t kept = *first;
      for (auto i = first + 1; i != last; ++i) {
        if (turned(*i) == turned(kept)) {
          *i = kNone;
        } else {
          kept = *i;
        }
      }
    }
  });
}

// Sheets modelled with a face on either side would be non-manifold everywhere. Where both sides use the same wedges,
// one stands for both: the later one is marked here with its partner, kNone for all others.
std::vector<std::uint32_t> find_backs(const Mesh& mesh, const std::vector<Triangle>& triangles,
                                      const TriangleOrder& order, const Task& task) {
  std::vector<std::uint32_t> front_of(triangles.size(), kNone);
  const auto sorted = [](Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  const auto group = [&](std::uint32_t t) { return mesh.face_group.empty() ? 0 : mesh.face_group[t]; };
  parallel_for(order.first.size() - 2, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t v = begin; v < end; ++v) {
      const std::size_t last = order.first[v + 1];
      if (last - order.first[v] > kMaxValence) continue;
      for (std::size_t i = order.first[v]; i < last; ++i) {
        const std::uint32_t back = order.triangle[i];
        for (std::size_t j = order.first[v]; j < last && back != kNone; ++j) {
          const std::uint32_t front = order.triangle[j];
          if (front == kNone || front >= back || front_of[front] != kNone) continue;
          if (sorted(triangles[front]) != sorted(triangles[back]) || group(front) != group(back)) continue;
          if (sorted(mesh.triangles[front]) == sorted(mesh.triangles[back])) front_of[back] = front;
        }
      }
    }
  });
  return front_of;
}

// The triangles that take part, by their lowest vertices, so that those of a star are near each other.
void take_triangles(State& state, const Mesh& mesh, const std::vector<std::uint32_t>& place, const Task& task) {
  std::vector<Triangle> renamed(mesh.triangles.size());
  parallel_for(renamed.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle v = mesh.vertices_of(t);
      renamed[t] = {place[v[0]], place[v[1]], place[v[2]]};
    }
  });
  TriangleOrder order = sort_triangles(renamed, mesh.vertex_count());
  mark_doubles(renamed, order, task);
  const std::vector<std::uint32_t> front_of = find_backs(mesh, renamed, order, task);
  std::vector<std::uint32_t>& kept = order.triangle;
  kept.resize(order.first[mesh.vertex_count()]);
  std::erase(kept, kNone);
  if (kept.size() < renamed.size()) {
    std::vector<std::uint8_t> taken(renamed.size(), 0);
    for (const std::uint32_t t : kept) taken[t] = 1;
    for (std::uint32_t t = 0; t < taken.size(); ++t) {
      if (taken[t] == 0) state.dropped.push_back(t);
    }
  }
  const auto is_back = [&](std::uint32_t t) { return front_of[t] != kNone; };
  state.backs = static_cast<std::size_t>(std::count_if(kept.begin(), kept.end(), is_back));
  if (state.backs > 0) {
    std::vector<std::uint8_t> has_back(renamed.size(), 0);
    for (const std::uint32_t front : front_of) {
      if (front != kNone) has_back[front] = 1;
    }
    std::erase_if(kept, is_back);
    for (const std::uint32_t t : kept) state.has_back.push_back(has_back[t]);
  }
  const std::size_t n = kept.size();
  const bool knows_wedges = !mesh.wedge_vertex.empty() || !mesh.attributes.empty();
  state.triangles.resize(n);
  state.normals.resize(n + 1);
  state.first_normals.resize(n);
  if (knows_wedges) state.wedges.resize(n);
  if (!mesh.face_group.empty()) state.groups.resize(n);
  parallel_for(n, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& c = renamed[kept[i]];
      state.triangles[i] = c;
      state.normals[i] = triangle_normal(state.positions[c[0]], state.positions[c[1]], state.positions[c[2]]);
      state.first_normals[i] = PackedDirection(state.normals[i].n);
      if (knows_wedges) state.wedges[i] = mesh.triangles[kept[i]];
      if (!mesh.face_group.empty()) state.groups[i] = mesh.face_group[kept[i]];
    }
  });
}

}  // namespace

Result<State> make_state(const Mesh& mesh, const EdgeCollapseOptions& options, const Task& task) {
  State state;
  state.fold_cosine = options.fold_cosine;
  Box3f box;
  for (const Vec3f p : mesh.positions) box.add(p);
  if (box.empty()) box.add(Vec3f{});
  choose_frame(state, mesh, box, options.metric, task);
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
  for (const Vec3f p : state.positions) {
    state.rounding = std::max({state.rounding, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  state.rounding *= 4 * std::numeric_limits<float>::epsilon();
  for (std::size_t i = 0; i < n && !options.weights.empty(); ++i) {
    state.weights.push_back(options.weights[state.original[i]]);
  }
  state.accumulated_error.assign(n, 0);
  take_wedges(state, mesh, task);
  take_triangles(state, mesh, place, task);
  if (!state.wedges.empty()) take_attributes(state, mesh, options.attribute_weights);
  classify_vertices(state, options, task);
  if (task.cancelled()) return cancelled_error("edge collapse");
  return state;
}

void build_stars(State& state, const Task& task) {
  const std::size_t n = state.positions.size();
  std::vector<std::uint32_t> end(n + 1, 0);  // first where each star begins, and once it is filled where it ends
  for (const Triangle& t : state.triangles) {
    for (const std::uint32_t v : t) ++end[v];
  }
  state.star_memory.resize(exclusive_scan(end, task));
  for (std::uint32_t t = 0; t < state.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) state.star_memory[end[state.triangles[t][k]]++] = t << 2 | k;
  }
  state.stars.resize(n);
  state.notes.resize(n);
  state.zone.resize(n);
  parallel_for(n, kChunk, task, [&](std::size_t begin, std::size_t last, std::size_t) {
    for (std::size_t v = begin; v < last; ++v) {
      const std::uint32_t first = v == 0 ? 0 : end[v - 1], count = end[v] - first;
      state.stars[v] = {state.star_memory.data() + first, count, count};
      state.notes[v] = {};
      state.zone[v] = count > kMaxValence ? kHeavy : 0;
    }
  });
}

}  // namespace lodestone::simplify::detail
