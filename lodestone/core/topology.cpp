// Counts that describe a mesh's connectivity: edges by their triangles, manifoldness, pieces, doubled faces.
//
// Everything goes by vertices (positions), so that seams of attributes don't count, as an independent checker would
// have it. Triangles that repeat a vertex have no edges.
// 1. count_duplicates(): faces with the three vertices of an earlier one, by sorting.
// 2. same_faces(), without_doubles(): a sheet whose faces are all listed twice has no edge with one triangle, and is
//    open all the same. Its border shows once doubled faces are taken for one, or for none.
// 3. is_manifold_vertex(): whether the edges opposite to a vertex form one path or one ring.
// 4. topology_of(): triangles, then edges (boundary, non-manifold, walked twice the same way),
//    then vertices, then pieces.
// Invariants: the mesh stays as it is; counts do not depend on the order of its triangles or on threads.
// Cost: O(n log n).
#include "lodestone/core/topology.h"

#include <algorithm>
#include <numeric>

#include "lodestone/base/parallel.h"
#include "lodestone/core/adjacency.h"
#include "lodestone/core/parts.h"
#include "lodestone/math/triangle.h"

namespace lodestone {

namespace {

bool repeats_vertex(const Triangle& v) { return v[0] == v[1] || v[1] == v[2] || v[2] == v[0]; }

std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

std::uint64_t count_duplicates(const Mesh& mesh, const Task& task) {
  std::vector<Triangle> faces;
  faces.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle v = mesh.vertices_of(t);
    std::sort(v.begin(), v.end());
    faces.push_back(v);
  }
  parallel_sort(faces, task, std::less<>{});
  std::uint64_t count = 0;
  for (std::size_t i = 1; i < faces.size(); ++i) count += faces[i] == faces[i - 1] ? 1 : 0;
  return count;
}

// Faces with the same three vertices.
struct SameFaces {
  Triangle sorted;
  std::uint32_t part = 0;
  bool cancels = false;  // as many face one way as the other
};

std::vector<SameFaces> same_faces(const Mesh& mesh, const Parts& parts, const Task& task) {
  struct Face {
    Triangle sorted;
    std::uint32_t triangle;
    bool turned;  // an odd permutation of `sorted`
  };
  std::vector<Face> faces;
  faces.reserve(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle v = mesh.vertices_of(t);
    if (repeats_vertex(v)) continue;
    Triangle sorted = v;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t lowest = v[0] == sorted[0] ? 0 : v[1] == sorted[0] ? 1 : 2;
    faces.push_back({sorted, t, v[(lowest + 1) % 3] != sorted[1]});
  }
  parallel_sort(faces, task, [](const Face& a, const Face& b) {
    return std::pair(a.sorted, a.triangle) < std::pair(b.sorted, b.triangle);
  });
  std::vector<SameFaces> out;
  for (std::size_t i = 0, end = 0; i < faces.size(); i = end) {
    std::int64_t balance = 0;
    for (end = i; end < faces.size() && faces[end].sorted == faces[i].sorted; ++end)
      balance += faces[end].turned ? -1 : 1;
    out.push_back({faces[i].sorted, parts.of_vertex[faces[i].sorted[0]], balance == 0});
  }
  return out;
}

// A sheet whose faces are all listed twice has no edge with one triangle, and is open all the same. So faces with the
// same vertices count once here, and those that lie back to back (flaps on a closed surface) not at all; but in a part
// that is nothing but faces back to back each counts once.
Mesh without_doubles(const Mesh& mesh, const Parts& parts, const Task& task) {
  const std::vector<SameFaces> faces = same_faces(mesh, parts, task);
  std::vector<std::uint8_t> is_sheet(parts.count, 1);
  for (const SameFaces& face : faces) {
    if (!face.cancels) is_sheet[face.part] = 0;
  }
  Mesh out;
  out.positions.resize(mesh.positions.size());
  for (const SameFaces& face : faces) {
    if (!face.cancels || is_sheet[face.part] != 0) out.triangles.push_back(face.sorted);
  }
  return out;
}

std::uint64_t count_boundary_edges(const Mesh& mesh, const Task& task) {
  const EdgeTriangles edges = edge_triangles(mesh, task);
  return static_cast<std::uint64_t>(
      std::count_if(edges.edges.begin(), edges.edges.end(), [](const Edge& edge) { return edge.count == 1; }));
}

// The edges opposite to v must form one path or one ring: no end met by three of them, at most two by one, all
// connected. O(valence log valence). `ids` and `links` are scratch.
bool is_manifold_vertex(const Mesh& mesh, std::uint32_t v, std::span<const std::uint32_t> star,
                        std::vector<std::uint32_t>& ids, std::vector<std::uint32_t>& links) {
  links.clear();
  for (const std::uint32_t t : star) {
    const Triangle c = mesh.vertices_of(t);
    if (repeats_vertex(c)) continue;
    const std::size_t k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
    links.insert(links.end(), {c[(k + 1) % 3], c[(k + 2) % 3]});
  }
  if (links.empty()) return true;
  ids = links;
  std::sort(ids.begin(), ids.end());
  std::size_t odd = 0;
  for (std::size_t i = 0, j = 0; i < ids.size(); i = j) {
    while (j < ids.size() && ids[j] == ids[i]) ++j;
    if (j - i > 2) return false;
    odd += j - i == 1 ? 1 : 0;
  }
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::vector<std::uint32_t> parent(ids.size());
  std::iota(parent.begin(), parent.end(), 0U);
  std::size_t pieces = ids.size();
  const auto id = [&](std::uint32_t w) {
    return static_cast<std::uint32_t>(std::lower_bound(ids.begin(), ids.end(), w) - ids.begin());
  };
  for (std::size_t i = 0; i < links.size(); i += 2) {
    const std::uint32_t a = find_root(parent, id(links[i])), b = find_root(parent, id(links[i + 1]));
    pieces -= a != b ? 1 : 0;
    parent[b] = a;
  }
  return odd <= 2 && pieces == 1;
}

}  // namespace

Topology topology_of(const Mesh& mesh, const Task& task) {
  Topology out;
  out.triangles = mesh.triangles.size();
  std::vector<std::uint8_t> used(mesh.vertex_count(), 0);  // 1 = by a proper triangle, 2 = by a degenerate one only
  std::vector<std::uint8_t> used_wedge(mesh.wedge_count(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle v = mesh.vertices_of(t);
    const bool repeats = repeats_vertex(v);
    const Vec3d n = scaled_normal(to_double(mesh.positions[v[0]]), to_double(mesh.positions[v[1]]),
                                  to_double(mesh.positions[v[2]]));
    out.degenerate_triangles += repeats || n == Vec3d{} ? 1 : 0;
    for (const std::uint32_t c : v) used[c] = repeats && used[c] != 1 ? 2 : 1;
    for (const std::uint32_t w : mesh.triangles[t]) used_wedge[w] = 1;
  }
  for (const std::uint8_t u : used) out.vertices += u != 0 ? 1 : 0;
  for (const std::uint8_t u : used_wedge) out.wedges += u;
  out.duplicate_faces = count_duplicates(mesh, task);
  const EdgeTriangles edges = edge_triangles(mesh, task);
  out.edges = edges.edges.size();
  for (const Edge& edge : edges.edges) {
    out.boundary_edges += edge.count == 1 ? 1 : 0;
    out.nonmanifold_edges += edge.count > 2 ? 1 : 0;
    if (edge.count != 2) continue;
    int forward = 0;
    for (const std::uint32_t t : edges.of(edge)) {
      const Triangle v = mesh.vertices_of(t);
      for (std::size_t k = 0; k < 3; ++k) forward += v[k] == edge.a && v[(k + 1) % 3] == edge.b ? 1 : 0;
    }
    out.inconsistent_edges += forward != 1 ? 1 : 0;
  }
  const VertexTriangles stars = vertex_triangles(mesh);
  std::vector<std::uint32_t> ids, links;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    if (used[v] == 1 && !is_manifold_vertex(mesh, v, stars.of(v), ids, links)) ++out.nonmanifold_vertices;
  }
  const Parts parts = parts_of(mesh);
  out.components = parts.count;
  if (out.duplicate_faces > 0) {
    out.hidden_boundary_edges = count_boundary_edges(without_doubles(mesh, parts, task), task);
  }
  out.closed = out.edges > 0 && out.boundary_edges == 0 && out.hidden_boundary_edges == 0;
  out.manifold = out.edges > 0 && out.nonmanifold_edges == 0 && out.nonmanifold_vertices == 0;
  return out;
}

}  // namespace lodestone
