// Open3D: TriangleMesh::SimplifyQuadricDecimation.
#include <open3d/geometry/TriangleMesh.h>

#include <limits>

#include "bench/peers/peer.h"

namespace {

peers::Triangles quadric(const peers::Triangles& in, std::size_t target, double& seconds) {
  open3d::geometry::TriangleMesh mesh;
  for (std::size_t v = 0; v < in.vertices(); ++v) {
    mesh.vertices_.emplace_back(in.positions[3 * v], in.positions[3 * v + 1], in.positions[3 * v + 2]);
  }
  for (std::size_t t = 0; t < in.triangles(); ++t) {
    mesh.triangles_.emplace_back(static_cast<int>(in.indices[3 * t]), static_cast<int>(in.indices[3 * t + 1]),
                                 static_cast<int>(in.indices[3 * t + 2]));
  }
  std::shared_ptr<open3d::geometry::TriangleMesh> result;
  seconds = peers::seconds_of([&] {
    result = mesh.SimplifyQuadricDecimation(static_cast<int>(target), std::numeric_limits<double>::infinity(), 1);
  });
  peers::Triangles out;
  for (const auto& p : result->vertices_) {
    for (int k = 0; k < 3; ++k) out.positions.push_back(static_cast<float>(p[k]));
  }
  for (const auto& t : result->triangles_) {
    for (int k = 0; k < 3; ++k) out.indices.push_back(static_cast<std::uint32_t>(t[k]));
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) { return peers::run(argc, argv, {{"quadric", quadric}}); }
