// Any level from the log of one edge-collapse run.
//
// Source: the idea of a progressive mesh, [progressive-mesh], section 2.2: a record of collapses is all levels at once.
// Here a level is not reached step by step but replayed from the original in a few passes over flat arrays.
// replay() of the first n collapses:
// 1. fates_after(): backwards over the prefix, where each vertex and wedge ends up; the fate of the kept one is known
//    before that of the removed one is asked for, so one step finds it.
// 2. keep_triangles(): triangles whose corners still differ stay, with their wedges replaced.
// 3. move_positions(), blend_attributes(): forwards, what each collapse did to position and wedges.
// 4. compact(): vertices and wedges that are used, in their original order.
// 5. repair_corner_normals() (corner_normals.h): normals of corners whose surroundings changed.
// Invariants: mesh and log stay as they are; triangles, vertices and wedges keep their order, so a level depends on
// mesh, log and n alone. Cost: O(mesh + n).
#include "lodestone/core/collapse_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "lodestone/base/parallel.h"
#include "lodestone/core/blend.h"
#include "lodestone/core/corner_normals.h"
#include "lodestone/core/validate.h"

namespace lodestone {

std::size_t CollapseLog::triangles_after(std::size_t count) const {
  std::size_t left = start_triangles;
  for (std::size_t i = 0; i < count; ++i) left -= collapses[i].faces;
  return left;
}

std::size_t CollapseLog::prefix_for(std::size_t triangles) const {
  std::size_t left = start_triangles, count = 0;
  while (left > triangles && count < collapses.size()) left -= collapses[count++].faces;
  return count;
}

namespace {

constexpr std::size_t kChunk = std::size_t{1} << 15;

// Where each vertex and wedge ends up after the prefix. Backwards, so that the kept one's fate is already known.
struct Fates {
  std::vector<std::uint32_t> vertex, wedge;
};

Fates fates_after(const Mesh& mesh, const CollapseLog& log, std::size_t count) {
  Fates fates;
  fates.vertex.resize(mesh.vertex_count());
  std::iota(fates.vertex.begin(), fates.vertex.end(), 0U);
  for (std::size_t i = count; i-- > 0;) fates.vertex[log.collapses[i].removed] = fates.vertex[log.collapses[i].kept];
  if (mesh.wedge_vertex.empty()) return fates;
  fates.wedge.resize(mesh.wedge_count());
  std::iota(fates.wedge.begin(), fates.wedge.end(), 0U);
  const std::size_t wedges = count < log.collapses.size() ? log.collapses[count].first_wedge : log.wedges.size();
  for (std::size_t i = wedges; i-- > 0;) {
    const WedgeMerge& merge = log.wedges[i];
    if (merge.ends) fates.wedge[merge.removed] = fates.wedge[merge.kept];
  }
  return fates;
}

bool has(const std::vector<std::uint8_t>& flags, std::size_t i) { return !flags.empty() && flags[i] != 0; }

// Triangles that keep three different vertices, with their wedges replaced.
void keep_triangles(const Mesh& mesh, const CollapseLog& log, const Fates& fates, const ReplayOptions& options,
                    ReplayResult& out, const Task& task) {
  const std::size_t n = mesh.triangles.size();
  const std::size_t chunks = (n + kChunk - 1) / kChunk;
  std::vector<std::uint32_t> start(chunks, 0);
  std::vector<std::uint8_t> keep(n, 1);
  for (const std::uint32_t t : log.dropped) keep[t] = 0;
  parallel_for(n, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle v = mesh.vertices_of(t);
      const std::uint32_t a = fates.vertex[v[0]], b = fates.vertex[v[1]], c = fates.vertex[v[2]];
      if (a == b || b == c || c == a) keep[t] = 0;
      if (has(options.left_out, t)) keep[t] = 0;
      if (has(options.untouched, t)) keep[t] = 1;
      start[chunk] += keep[t];
    }
  });
  const std::uint64_t kept = exclusive_scan(start);
  out.origin.resize(kept);
  out.mesh.triangles.resize(kept);
  if (!mesh.face_group.empty()) out.mesh.face_group.resize(kept);
  const std::vector<std::uint32_t>& fate = mesh.wedge_vertex.empty() ? fates.vertex : fates.wedge;
  parallel_for(n, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    std::size_t next = start[chunk];
    for (std::size_t t = begin; t < end; ++t) {
      if (keep[t] == 0) continue;
      const Triangle& w = mesh.triangles[t];
      out.mesh.triangles[next] = {fate[w[0]], fate[w[1]], fate[w[2]]};
      out.origin[next] = static_cast<std::uint32_t>(t);
      if (!mesh.face_group.empty()) out.mesh.face_group[next] = mesh.face_group[t];
      ++next;
    }
  });
}

// Numbers what is used in ascending order: writes the numbers to `new_name` and returns the list of what is kept.
std::vector<std::uint32_t> compact_names(std::size_t n, const std::vector<std::uint8_t>& used,
                                         std::vector<std::uint32_t>& new_name) {
  std::vector<std::uint32_t> kept;
  new_name.assign(n, kNone);
  for (std::uint32_t i = 0; i < n; ++i) {
    if (used[i] == 0) continue;
    new_name[i] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(i);
  }
  return kept;
}

void move_positions(const CollapseLog& log, std::size_t count, std::vector<Vec3f>& positions) {
  for (std::size_t i = 0; i < count; ++i) positions[log.collapses[i].kept] = log.collapses[i].position;
}

std::vector<AttributeStream> blend_attributes(const Mesh& mesh, const CollapseLog& log, std::size_t count) {
  std::vector<AttributeStream> streams = mesh.attributes;
  if (streams.empty()) return streams;
  AttributeBlender blender(streams);
  const std::size_t wedges = count < log.collapses.size() ? log.collapses[count].first_wedge : log.wedges.size();
  for (std::size_t i = 0; i < wedges; ++i)
    blender.blend(log.wedges[i].kept, log.wedges[i].removed, log.wedges[i].blend);
  return streams;
}

void pick_tuples(const std::vector<AttributeStream>& from, const std::vector<std::uint32_t>& kept, Mesh& into) {
  for (const AttributeStream& stream : from) {
    AttributeStream picked = stream;
    std::visit(
        [&](auto& values) {
          const auto& all = std::get<std::decay_t<decltype(values)>>(stream.values);
          const std::size_t c = stream.components;
          values.resize(kept.size() * c);
          for (std::size_t i = 0; i < kept.size(); ++i) {
            std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(kept[i] * c), c,
                        values.begin() + static_cast<std::ptrdiff_t>(i * c));
          }
        },
        picked.values);
    into.attributes.push_back(std::move(picked));
  }
}

// Vertices and wedges that triangles use, in ascending order of their original index.
void compact(const Mesh& mesh, const CollapseLog& log, std::size_t count, ReplayResult& out) {
  std::vector<std::uint8_t> used_wedge(mesh.wedge_count(), 0);
  for (const Triangle& t : out.mesh.triangles) {
    for (const std::uint32_t w : t) used_wedge[w] = 1;
  }
  std::vector<std::uint32_t> wedge_name;
  const std::vector<std::uint32_t> kept_wedges = compact_names(mesh.wedge_count(), used_wedge, wedge_name);
  for (Triangle& t : out.mesh.triangles) {
    for (std::uint32_t& w : t) w = wedge_name[w];
  }
  std::vector<Vec3f> positions = mesh.positions;
  move_positions(log, count, positions);
  std::vector<std::uint32_t> kept_vertices = kept_wedges;
  if (!mesh.wedge_vertex.empty()) {
    std::vector<std::uint8_t> used_vertex(mesh.vertex_count(), 0);
    const Fates fates = fates_after(mesh, log, count);
    for (const std::uint32_t w : kept_wedges) used_vertex[fates.vertex[mesh.wedge_vertex[w]]] = 1;
    std::vector<std::uint32_t> vertex_name;
    kept_vertices = compact_names(mesh.vertex_count(), used_vertex, vertex_name);
    out.mesh.wedge_vertex.reserve(kept_wedges.size());
    for (const std::uint32_t w : kept_wedges) {
      out.mesh.wedge_vertex.push_back(vertex_name[fates.vertex[mesh.wedge_vertex[w]]]);
    }
  }
  out.mesh.positions.reserve(kept_vertices.size());
  for (const std::uint32_t v : kept_vertices) out.mesh.positions.push_back(positions[v]);
  pick_tuples(blend_attributes(mesh, log, count), kept_wedges, out.mesh);
  out.vertex_origin = std::move(kept_vertices);
}

Result<void> check(const Mesh& mesh, const CollapseLog& log, std::size_t count, const ReplayOptions& options,
                   const Task& task) {
  const auto bad = [](std::string what) { return fail(ErrorCode::bad_argument, std::move(what), "replay"); };
  if (count > log.collapses.size()) {
    return bad(fmt::format("{} collapses are asked for, the log has {}", count, log.collapses.size()));
  }
  for (const std::vector<std::uint8_t>* list : {&options.left_out, &options.untouched}) {
    if (list->empty() || list->size() == mesh.triangles.size()) continue;
    return bad(fmt::format("a list of {} triangles is about {}", list->size(), mesh.triangles.size()));
  }
  if (options.input == Input::valid) return {};
  LODESTONE_TRY(validate(mesh, task));
  return validate(log, mesh, task);
}

}  // namespace

Result<ReplayResult> replay(const Mesh& mesh, const CollapseLog& log, std::size_t count, Task task) {
  return replay(mesh, log, count, ReplayOptions{}, std::move(task));
}

Result<ReplayResult> replay(const Mesh& mesh, const CollapseLog& log, std::size_t count, const ReplayOptions& options,
                            Task task) {
  LODESTONE_TRY(check(mesh, log, count, options, task));
  ReplayResult out;
  out.mesh.name = mesh.name;
  out.mesh.offset = mesh.offset;
  out.mesh.groups = mesh.groups;
  keep_triangles(mesh, log, fates_after(mesh, log, count), options, out, task);
  if (task.cancelled()) return cancelled_error("replaying collapses");
  compact(mesh, log, count, out);
  if (count > 0) repair_corner_normals(mesh, out.origin, out.mesh, options.untouched);
  if (task.cancelled()) return cancelled_error("replaying collapses");
  return out;
}

}  // namespace lodestone
