// OpenMesh 9: decimater with quadrics.
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include "bench/peers/peer.h"

namespace {

using Mesh = OpenMesh::TriMesh_ArrayKernelT<>;

peers::Triangles quadric(const peers::Triangles& in, std::size_t target, double& seconds) {
  Mesh mesh;
  std::vector<Mesh::VertexHandle> vertices;
  for (std::size_t v = 0; v < in.vertices(); ++v) {
    vertices.push_back(mesh.add_vertex({in.positions[3 * v], in.positions[3 * v + 1], in.positions[3 * v + 2]}));
  }
  for (std::size_t t = 0; t < in.triangles(); ++t) {
    mesh.add_face(vertices[in.indices[3 * t]], vertices[in.indices[3 * t + 1]], vertices[in.indices[3 * t + 2]]);
  }
  seconds = peers::seconds_of([&] {
    OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
    OpenMesh::Decimater::ModQuadricT<Mesh>::Handle module;
    decimater.add(module);
    decimater.module(module).unset_max_err();
    decimater.initialize();
    decimater.decimate_to_faces(0, target);
    mesh.garbage_collection();
  });
  peers::Triangles out;
  for (const auto v : mesh.vertices()) {
    for (int k = 0; k < 3; ++k) out.positions.push_back(mesh.point(v)[k]);
  }
  for (const auto f : mesh.faces()) {
    for (auto v = mesh.cfv_iter(f); v.is_valid(); ++v) out.indices.push_back(static_cast<std::uint32_t>(v->idx()));
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) { return peers::run(argc, argv, {{"quadric", quadric}}); }
