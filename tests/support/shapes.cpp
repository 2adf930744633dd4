#include "support/shapes.h"

#include <cmath>
#include <numbers>

#include "lodestone/base/random.h"

namespace lodestone::test {

Mesh make_mesh(std::vector<Vec3f> positions, std::vector<Triangle> triangles) {
  Mesh mesh;
  mesh.positions = std::move(positions);
  mesh.triangles = std::move(triangles);
  return mesh;
}

Mesh tetrahedron() {
  return make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
}

Mesh cube() {
  std::vector<Vec3f> p;
  for (int i = 0; i < 8; ++i) p.push_back({float(i & 1), float((i >> 1) & 1), float((i >> 2) & 1)});
  return make_mesh(p, {{0, 2, 1},
                       {1, 2, 3},
                       {4, 5, 6},
                       {5, 7, 6},
                       {0, 1, 4},
                       {1, 5, 4},
                       {2, 6, 3},
                       {3, 6, 7},
                       {0, 4, 2},
                       {2, 4, 6},
                       {1, 3, 5},
                       {3, 7, 5}});
}

Mesh cube_with_seams() {
  Mesh in = cube();
  Mesh out;
  out.positions = in.positions;
  AttributeStream uv = make_stream("TEXCOORD_0", Semantic::uv, 2, ComponentType::float32, false, 0);
  AttributeStream normal = make_stream("NORMAL", Semantic::normal, 3, ComponentType::float32, false, 0);
  auto& uvs = std::get<std::vector<float>>(uv.values);
  auto& normals = std::get<std::vector<float>>(normal.values);
  for (std::size_t face = 0; face < 6; ++face) {
    const std::size_t axis = face < 2 ? 2 : face < 4 ? 1 : 0;
    std::vector<std::uint32_t> wedge(8, kNone);
    for (std::size_t half = 0; half < 2; ++half) {
      Triangle t = in.triangles[face * 2 + half];
      for (std::uint32_t& corner : t) {
        if (wedge[corner] == kNone) {
          wedge[corner] = static_cast<std::uint32_t>(out.wedge_vertex.size());
          out.wedge_vertex.push_back(corner);
          const Vec3f p = in.positions[corner];
          uvs.insert(uvs.end(), {axis == 0 ? p.y : p.x, axis == 2 ? p.y : p.z});
          Vec3f n{};
          n[axis] = face % 2 == 1 ? 1.0F : -1.0F;
          normals.insert(normals.end(), {n.x, n.y, n.z});
        }
        corner = wedge[corner];
      }
      out.triangles.push_back(t);
    }
  }
  out.attributes = {normal, uv};
  return out;
}

Mesh grid(int cells, float bend) {
  Mesh mesh;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const float x = float(i) / float(cells), y = float(j) / float(cells);
      mesh.positions.push_back({x, y, bend * std::sin(7 * x) * std::cos(5 * y)});
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (cells + 1) + i); };
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

Mesh sphere(int rings) {
  Mesh mesh;
  const int segments = 2 * rings;
  mesh.positions.push_back({0, 0, 1});
  for (int r = 1; r < rings; ++r) {
    for (int s = 0; s < segments; ++s) {
      const double theta = std::numbers::pi * r / rings, phi = 2 * std::numbers::pi * s / segments;
      mesh.positions.push_back(
          to_float(Vec3d{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)}));
    }
  }
  mesh.positions.push_back({0, 0, -1});
  const auto at = [&](int r, int s) { return static_cast<std::uint32_t>(1 + (r - 1) * segments + s % segments); };
  const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  for (int s = 0; s < segments; ++s) {
    mesh.triangles.push_back({0, at(1, s), at(1, s + 1)});
    for (int r = 1; r + 1 < rings; ++r) {
      mesh.triangles.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
      mesh.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
    }
    mesh.triangles.push_back({last, at(rings - 1, s + 1), at(rings - 1, s)});
  }
  return mesh;
}

Mesh torus(int segments) {
  Mesh mesh;
  for (int i = 0; i < segments; ++i) {
    for (int j = 0; j < segments; ++j) {
      const double u = 2 * std::numbers::pi * i / segments, v = 2 * std::numbers::pi * j / segments;
      const double r = 1 + 0.4 * std::cos(v);
      mesh.positions.push_back(to_float(Vec3d{r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v)}));
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>((i % segments) * segments + j % segments); };
  for (int i = 0; i < segments; ++i) {
    for (int j = 0; j < segments; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

Mesh moebius(int segments) {
  Mesh mesh;
  for (int i = 0; i < segments; ++i) {
    const double u = 2 * std::numbers::pi * i / segments;
    for (const double w : {-0.3, 0.3}) {
      const double r = 1 + w * std::cos(u / 2);
      mesh.positions.push_back(to_float(Vec3d{r * std::cos(u), r * std::sin(u), w * std::sin(u / 2)}));
    }
  }
  for (int i = 0; i < segments; ++i) {
    const auto a = static_cast<std::uint32_t>(2 * i);
    const bool last = i + 1 == segments;
    const std::uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    mesh.triangles.push_back({a, c, a + 1});
    mesh.triangles.push_back({a + 1, c, d});
  }
  return mesh;
}

Mesh bow_tie() { return make_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}); }

Mesh three_faces_on_an_edge() {
  return make_mesh({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}});
}

Mesh offset_plates(int cells) {
  Mesh mesh = grid(cells);
  const Mesh other = grid(cells);
  const auto shift = static_cast<std::uint32_t>(mesh.positions.size());
  for (Vec3f p : other.positions) mesh.positions.push_back({p.x, p.y, 1e-3F});
  for (const Triangle& t : other.triangles) mesh.triangles.push_back({t[0] + shift, t[2] + shift, t[1] + shift});
  return mesh;
}

Mesh soup(unsigned seed, int vertices, int triangles) {
  Mesh mesh;
  std::uint64_t counter = 0;
  const auto next = [&] { return random_unit(seed, counter++); };
  for (int i = 0; i < vertices; ++i) mesh.positions.push_back(to_float(Vec3d{next(), next(), next()}));
  const auto pick = [&] { return static_cast<std::uint32_t>(next() * vertices); };
  for (int i = 0; i < triangles; ++i) mesh.triangles.push_back({pick(), pick(), pick()});
  return mesh;
}

Mesh canopy(int leaves) {
  Mesh mesh = sphere(8);  // 224 triangles, drawn out to a column
  for (Vec3f& p : mesh.positions) p = {p.x * 0.1F, p.y * 0.1F, p.z * 2};
  std::uint64_t counter = 0;
  const auto random = [&] { return static_cast<float>(random_unit(11, counter++)) * 2 - 1; };
  for (int i = 0; i < leaves; ++i) {
    Vec3f at{2, 2, 2};
    while (length_sq(at) > 1) at = {random(), random(), random()};
    const Vec3f u = normalized(Vec3f{random(), random(), random()}) * 0.05F;
    const Vec3f v = normalized(cross(u, Vec3f{random(), random(), random()})) * 0.05F;
    const Vec3f c = at * 1.5F + Vec3f{0, 0, 3};
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3f& corner : {c - u - v, c + u - v, c + u + v, c - u + v}) mesh.positions.push_back(corner);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

std::vector<Shape> small_shapes() {
  return {
      {"tetrahedron", tetrahedron, true},
      {"cube", cube, true},
      {"cube_with_seams", cube_with_seams, true},
      {"one_triangle",
       [] {
         return make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
       },
       false},
      {"grid", [] { return grid(12, 0.1F); }, false},
      {"flat_grid", [] { return grid(12); }, false},
      {"grid_with_uv_seam", [] { return with_uv_seam(grid(12, 0.1F)); }, false},
      {"sphere", [] { return sphere(12); }, true},
      {"torus", [] { return torus(16); }, true},
      {"moebius", [] { return moebius(40); }, false},
      {"bow_tie", bow_tie, false},
      {"three_faces_on_an_edge", three_faces_on_an_edge, false},
      {"offset_plates", [] { return offset_plates(10); }, false},
      {"soup", [] { return soup(1, 30, 120); }, false},
      {"far_from_the_origin",
       [] {
         Mesh mesh = sphere(12);
         mesh.offset = {1e7, -1e7, 1e7};
         return mesh;
       },
       true},
      {"doubled_face",
       [] {
         Mesh mesh = cube();
         mesh.triangles.push_back(mesh.triangles[3]);
         return mesh;
       },
       false},
      {"zero_area_face",
       [] {
         Mesh mesh = grid(4);
         mesh.triangles.push_back({0, 1, 2});
         mesh.triangles.push_back({3, 3, 4});
         return mesh;
       },
       false},
  };
}

Mesh with_uv_seam(Mesh mesh) {
  Mesh out;
  out.positions = mesh.positions;
  AttributeStream uv = make_stream("TEXCOORD_0", Semantic::uv, 2, ComponentType::float32, false, 0);
  auto& values = std::get<std::vector<float>>(uv.values);
  std::vector<std::uint32_t> left(mesh.positions.size(), kNone), right = left;
  for (const Triangle& t : mesh.triangles) {
    float x = 0;
    for (const std::uint32_t v : t) x += mesh.positions[v].x / 3;
    std::vector<std::uint32_t>& side = x < 0.5F ? left : right;
    Triangle wedges{};
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& wedge = side[t[k]];
      if (wedge == kNone) {
        wedge = static_cast<std::uint32_t>(out.wedge_vertex.size());
        out.wedge_vertex.push_back(t[k]);
        const Vec3f p = mesh.positions[t[k]];
        values.insert(values.end(), {x < 0.5F ? p.x : p.x + 2, p.y});
      }
      wedges[k] = wedge;
    }
    out.triangles.push_back(wedges);
  }
  // Away from x = 0.5 both sides would be equal only if they were the same chart; here each vertex is on one side or
  // both.
  out.attributes = {uv};
  return out;
}

}  // namespace lodestone::test
