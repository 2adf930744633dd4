// Any triangles on few vertices: edge collapse ends, and its result is valid and no worse than the input.
#include <cstddef>
#include <cstdint>

#include "lodestone/base/check.h"
#include "lodestone/core/topology.h"
#include "lodestone/core/validate.h"
#include "lodestone/simplify/collapse/edge_collapse.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestone;
  if (size < 8) return 0;
  Mesh mesh;
  const std::uint32_t vertices = 3 + data[0] % 24;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const std::uint8_t b = data[1 + v % (size - 1)];
    mesh.positions.push_back({static_cast<float>(b & 7), static_cast<float>(b >> 3 & 7), static_cast<float>(v % 5)});
  }
  for (std::size_t i = 1; i + 2 < size && mesh.triangles.size() < 400; i += 3) {
    mesh.triangles.push_back({data[i] % vertices, data[i + 1] % vertices, data[i + 2] % vertices});
  }
  if (mesh.triangles.empty()) return 0;
  simplify::EdgeCollapseOptions options;
  options.target_triangles = 1;
  const auto result = simplify::collapse_edges(mesh, options);
  LODESTONE_CHECK(result && validate(result->mesh), "the result is valid");
  const Topology before = topology_of(mesh), after = topology_of(result->mesh);
  LODESTONE_CHECK(after.nonmanifold_edges <= before.nonmanifold_edges, "no new non-manifold edges");
  LODESTONE_CHECK(after.duplicate_faces <= before.duplicate_faces, "no new duplicate faces");
  return 0;
}
