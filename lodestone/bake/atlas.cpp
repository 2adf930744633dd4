#include "lodestone/bake/atlas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lodestone/bake/charts_detail.h"
#include "lodestone/bake/flat_charts_detail.h"
#include "lodestone/bake/pack_detail.h"
#include "lodestone/base/parallel.h"
#include "lodestone/core/tangents.h"
#include "lodestone/core/validate.h"

namespace lodestone::bake {

using detail::FlatChart;
using detail::Packing;

namespace {

Result<void> check(const Mesh& target, const AtlasOptions& options) {
  if (target.triangles.empty()) return fail(ErrorCode::empty, "the target has no triangle");
  if (options.texture_size < 16 || options.texture_size > 16384) {
    return fail(ErrorCode::bad_argument,
                fmt::format("a texture of {} texels; 16 to 16384 are possible", options.texture_size));
  }
  if (options.gutter_texels > options.texture_size / 8) {
    return fail(ErrorCode::bad_argument, fmt::format("a gutter of {} texels in a texture of {}; an eighth is the most",
                                                     options.gutter_texels, options.texture_size));
  }
  return {};
}

// Copies tuple from[i] of each stream to place i.
void pick_tuples(AttributeStream& stream, const std::vector<std::uint32_t>& from) {
  std::visit(
      [&](auto& values) {
        std::remove_reference_t<decltype(values)> picked;
        picked.reserve(from.size() * stream.components);
        for (const std::uint32_t w : from) {
          const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::size_t{w} * stream.components);
          picked.insert(picked.end(), at, at + static_cast<std::ptrdiff_t>(stream.components));
        }
        values = std::move(picked);
      },
      stream.values);
}

// Gives each pair of a wedge and a chart that uses it a wedge of its own, by rising wedge, then chart.
void split_wedges(Mesh& mesh, const std::vector<std::uint32_t>& chart, const Task& task) {
  std::vector<std::uint64_t> pairs;
  pairs.reserve(mesh.triangles.size() * 3);
  const auto pair_of = [&](std::size_t t, std::uint32_t wedge) { return std::uint64_t{wedge} << 32 | chart[t]; };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t w : mesh.triangles[t]) pairs.push_back(pair_of(t, w));
  }
  parallel_sort(pairs, task, std::less<>());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t& w : mesh.triangles[t]) {
      w = static_cast<std::uint32_t>(std::lower_bound(pairs.begin(), pairs.end(), pair_of(t, w)) - pairs.begin());
    }
  }
  std::vector<std::uint32_t> from, vertex;
  for (const std::uint64_t pair : pairs) {
    from.push_back(static_cast<std::uint32_t>(pair >> 32));
    vertex.push_back(mesh.vertex_of(from.back()));
  }
  for (AttributeStream& stream : mesh.attributes) pick_tuples(stream, from);
  mesh.wedge_vertex = std::move(vertex);
}

// The charts' coordinates as a stream; fills what the atlas tells of them.
void add_coordinates(const std::vector<FlatChart>& charts, const Packing& packing, double size, Atlas& atlas) {
  Mesh& mesh = atlas.mesh;
  AttributeStream stream =
      make_stream("TEXCOORD_0", Semantic::uv, 2, ComponentType::float32, false, mesh.wedge_count());
  auto& uv = std::get<std::vector<float>>(stream.values);
  double area = 0;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    for (std::size_t i = 0; i < charts[c].triangles.size(); ++i) {
      const Triangle& wedges = mesh.triangles[charts[c].triangles[i]];
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec2d p = packing.texel(c, charts[c].corners[i][k]);
        uv[2 * std::size_t{wedges[k]}] = static_cast<float>(std::clamp(p.x / size, 0.0, 1.0));
        uv[2 * std::size_t{wedges[k]} + 1] = static_cast<float>(std::clamp(1 - p.y / size, 0.0, 1.0));
      }
    }
    area += charts[c].area;
  }
  mesh.attributes.push_back(std::move(stream));
  atlas.used = area * packing.scale * packing.scale / (size * size);
  atlas.texels_per_unit = packing.scale;
}

}  // namespace

Result<Atlas> make_atlas(const Mesh& target, const AtlasOptions& options, Task task) {
  LODESTONE_TRY(check(target, options));
  LODESTONE_TRY(validate(target, task));
  task = task.part(1, "atlas");
  const detail::Neighbors neighbors = detail::neighbors_of(target, task);
  const std::vector<std::uint32_t> rough = detail::make_charts(target, neighbors, task.part(0.5));
  if (task.cancelled()) return cancelled_error("making an atlas");
  const std::vector<FlatChart> charts = detail::flatten_charts(target, neighbors, rough, task.part(0.2));
  if (task.cancelled()) return cancelled_error("making an atlas");
  const std::optional<Packing> packing =
      detail::pack_charts(charts, options.texture_size, options.gutter_texels, task.part(0.3));
  if (task.cancelled()) return cancelled_error("making an atlas");
  if (!packing) {
    return fail(ErrorCode::bad_argument,
                fmt::format("{} charts with gutters of {} texels don't fit a texture of {} texels", charts.size(),
                            options.gutter_texels, options.texture_size),
                {}, "take a larger texture or smaller gutters");
  }
  Atlas atlas;
  atlas.mesh = target;
  atlas.charts = static_cast<std::uint32_t>(charts.size());
  atlas.chart.resize(target.triangles.size());
  for (std::uint32_t c = 0; c < charts.size(); ++c) {
    for (const std::uint32_t t : charts[c].triangles) atlas.chart[t] = c;
  }
  std::erase_if(atlas.mesh.attributes,
                [](const AttributeStream& s) { return s.semantic == Semantic::uv && s.set == 0; });
  drop_tangents(atlas.mesh);
  split_wedges(atlas.mesh, atlas.chart, task);
  add_coordinates(charts, *packing, options.texture_size, atlas);
  return atlas;
}

}  // namespace lodestone::bake
