// Attributes that follow vertices which fitting has moved, so that textures don't swim.
//
// carry_attributes():
// 1. partners() finds the original's stream for each stream of the level that is carried: normals, texture coordinates,
//    colours and other numbers.
// 2. For each wedge of a moved vertex, chart_point() finds the points of the original that are closest to the vertex's
//    old and new position. Nothing is carried where these lie in different charts.
// 3. carry() adds the difference of the original's values between both points to the wedge's own. What collapses have
//    chosen to differ from the original stays different. Where the wedge's value is farther from the original's than
//    from those of its neighbours (reach()), the closest point belongs to another chart, and nothing is carried.
//
// Normals come out with length 1, colours within their range. Wedges don't depend on each other: the same bytes for any
// number of threads. O(wedges log triangles).
#include <algorithm>
#include <array>
#include <cmath>

#include "lodestone/base/parallel.h"
#include "lodestone/math/triangle.h"
#include "lodestone/simplify/fit/attributes_detail.h"

namespace lodestone::simplify::detail {

namespace {

// A place on the original: its triangle's wedges and their weights.
struct ChartPoint {
  Triangle wedges;
  std::array<double, 3> weights;
};

ChartPoint chart_point(const FitTarget& target, Vec3d p) {
  const spatial::Nearest near = target.tree().closest(p);
  const auto [a, b, c] = target.surface().corners(near.triangle);
  return {target.original().triangles[target.surface().drawn[near.triangle]], barycentric(near.point, a, b, c)};
}

bool is_carried(const AttributeStream& stream) {
  return stream.semantic == Semantic::normal || stream.semantic == Semantic::uv || stream.semantic == Semantic::color ||
         (stream.semantic == Semantic::generic && is_blendable(stream));
}

template <class T>
double value_at(const std::vector<T>& values, std::uint32_t components, const ChartPoint& spot, std::uint32_t c) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    sum += spot.weights[k] * static_cast<double>(values[std::size_t{spot.wedges[k]} * components + c]);
  }
  return sum;
}

// How far apart a stream's values are at the ends of a wedge's sides, at most.
template <class T>
double reach(const std::vector<T>& values, std::uint32_t components, std::uint32_t wedge,
             std::span<const Triangle> triangles) {
  double most = 0;
  for (const Triangle& t : triangles) {
    for (const std::uint32_t other : t) {
      double sum = 0;
      for (std::uint32_t c = 0; c < components; ++c) {
        const double d = static_cast<double>(values[std::size_t{other} * components + c]) -
                         static_cast<double>(values[std::size_t{wedge} * components + c]);
        sum += d * d;
      }
      most = std::max(most, sum);
    }
  }
  return std::sqrt(most);
}

// The triangles around each wedge.
struct TrianglesAt {
  std::vector<std::uint32_t> first;
  std::vector<Triangle> list;

  explicit TrianglesAt(const Mesh& mesh) : first(mesh.wedge_count() + 1, 0), list(mesh.triangles.size() * 3) {
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t w : t) ++first[w];
    }
    exclusive_scan(first);
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t w : t) list[next[w]++] = t;
    }
  }
  std::span<const Triangle> of(std::uint32_t wedge) const {
    return std::span(list).subspan(first[wedge], first[wedge + 1] - first[wedge]);
  }
};

template <class T>
void carry(const AttributeStream& original, const std::vector<T>& from, std::uint32_t wedge,
           const ChartPoint& old_point, const ChartPoint& new_point, std::span<const Triangle> around,
           const std::vector<T>& before, std::vector<T>& to) {
  const std::uint32_t n = original.components;
  std::vector<double> change(n);
  double off = 0;
  for (std::uint32_t c = 0; c < n; ++c) {
    const double then = value_at(from, n, old_point, c);
    change[c] = value_at(from, n, new_point, c) - then;
    const double d = static_cast<double>(before[std::size_t{wedge} * n + c]) - then;
    off += d * d;
  }
  // The closest point may be in another chart than the wedge, where values differ.
  if (std::sqrt(off) > reach(before, n, wedge, around)) return;
  double length_sq = 0;
  for (std::uint32_t c = 0; c < n; ++c) {
    T& value = to[std::size_t{wedge} * n + c];
    double sum = static_cast<double>(value) + change[c];
    if (original.semantic == Semantic::color) sum = std::clamp(sum, 0.0, std::max(1.0, static_cast<double>(value)));
    value = static_cast<T>(sum);
    length_sq += sum * sum;
  }
  if (original.semantic != Semantic::normal || !(length_sq > 0)) return;
  for (std::uint32_t c = 0; c < n; ++c) {
    T& value = to[std::size_t{wedge} * n + c];
    value = static_cast<T>(static_cast<double>(value) / std::sqrt(length_sq));
  }
}

// For each stream of the level that is carried, that of the original; null for the others. Levels may have fewer.
std::vector<const AttributeStream*> partners(const Mesh& original, const Mesh& level) {
  std::vector<const AttributeStream*> found;
  for (const AttributeStream& own : level.attributes) {
    found.push_back(nullptr);
    if (!is_carried(own)) continue;
    for (const AttributeStream& other : original.attributes) {
      if (other.semantic == own.semantic && other.set == own.set && other.name == own.name &&
          other.components == own.components) {
        found.back() = &other;
      }
    }
  }
  return found;
}

}  // namespace

void carry_attributes(const FitTarget& target, const std::vector<Vec3f>& before, Mesh& level, const Task& task) {
  const Mesh& original = target.original();
  if (target.charts().empty()) return;
  if (std::none_of(level.attributes.begin(), level.attributes.end(), is_carried)) return;
  const std::vector<const AttributeStream*> sources = partners(original, level);
  const TrianglesAt triangles(level);
  const std::vector<AttributeStream> old = level.attributes;  // what neighbours had
  parallel_for(level.wedge_count(), 1024, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto wedge = static_cast<std::uint32_t>(i);
      const std::uint32_t vertex = level.vertex_of(wedge);
      if (level.positions[vertex] == before[vertex]) continue;
      const ChartPoint then = chart_point(target, to_double(before[vertex]) + level.offset);
      const ChartPoint now = chart_point(target, level.position(vertex));
      if (target.charts()[then.wedges[0]] != target.charts()[now.wedges[0]]) continue;
      for (std::size_t s = 0; s < level.attributes.size(); ++s) {
        if (sources[s] == nullptr) continue;
        const AttributeStream& stream = *sources[s];
        std::visit(
            [&](auto& to) {
              using Values = std::remove_reference_t<decltype(to)>;
              if constexpr (!std::is_same_v<Values, std::vector<std::uint32_t>>) {
                const auto* from = std::get_if<Values>(&stream.values);
                const auto& own = std::get<Values>(old[s].values);
                if (from != nullptr) carry(stream, *from, wedge, then, now, triangles.of(wedge), own, to);
              }
            },
            level.attributes[s].values);
      }
    }
  });
}

}  // namespace lodestone::simplify::detail
