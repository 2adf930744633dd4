// Small meshes with known properties, for tests of every module.
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "lodestone/core/mesh.h"

namespace lodestone::test {

/// A mesh from plain lists, wedge = vertex.
Mesh make_mesh(std::vector<Vec3f> positions, std::vector<Triangle> triangles);

Mesh tetrahedron();
Mesh cube();                           ///< closed, 8 vertices, 12 triangles, [0,1]^3
Mesh cube_with_seams();                ///< 24 wedges with UVs and face normals on 8 vertices
Mesh grid(int cells, float bend = 0);  ///< open unit square of cells x cells x 2 triangles; z = bend * sin(...)
Mesh sphere(int rings);                ///< closed UV sphere of radius 1, `rings` x 2 rings segments
Mesh torus(int segments);              ///< closed, genus 1
Mesh moebius(int segments);            ///< cannot be oriented
Mesh bow_tie();                        ///< two fans that touch in one vertex
Mesh three_faces_on_an_edge();
Mesh offset_plates(int cells);  ///< unit squares at z = 0 and z = 1e-3, opposite windings
Mesh soup(unsigned seed, int vertices,
          int triangles);  ///< random triangles on few vertices: non-manifold, degenerate, doubled

/// A trunk (a closed column of 224 triangles, 4 high) and `leaves` leaves of two triangles and side 0.1 about its top,
/// turned at random, each a part of its own.
Mesh canopy(int leaves);

struct Shape {
  std::string name;
  std::function<Mesh()> make;
  bool closed_manifold;

  friend std::ostream& operator<<(std::ostream& out, const Shape& shape) { return out << shape.name; }
};
/// One of each kind, for laws that must hold on all.
std::vector<Shape> small_shapes();

/// As `mesh` with a UV stream that has a seam along x = 0.5 of the unit square: for grid().
Mesh with_uv_seam(Mesh mesh);

}  // namespace lodestone::test
