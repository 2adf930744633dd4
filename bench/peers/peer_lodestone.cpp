#include "bench/peers/peer.h"
#include "lodestone/base/parallel.h"
#include "lodestone/simplify/collapse/edge_collapse.h"

namespace {

using namespace lodestone;

peers::Triangles simplify_with(const peers::Triangles& in, std::size_t target, int threads, double& seconds) {
  const ThreadLimit limit(threads);
  Mesh mesh;
  for (std::size_t v = 0; v < in.vertices(); ++v) {
    mesh.positions.push_back({in.positions[3 * v], in.positions[3 * v + 1], in.positions[3 * v + 2]});
  }
  for (std::size_t t = 0; t < in.triangles(); ++t) {
    mesh.triangles.push_back({in.indices[3 * t], in.indices[3 * t + 1], in.indices[3 * t + 2]});
  }
  simplify::EdgeCollapseOptions options;
  options.target_triangles = target;
  Mesh small;
  seconds = peers::seconds_of(
      [&] { small = std::move(simplify::collapse_edges(mesh, options, Task::root({}, threads))->mesh); });
  peers::Triangles out;
  for (const Vec3f& p : small.positions) out.positions.insert(out.positions.end(), {p.x, p.y, p.z});
  for (const Triangle& t : small.triangles) out.indices.insert(out.indices.end(), t.begin(), t.end());
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  return peers::run(
      argc, argv,
      {{"1", [](const auto& in, std::size_t target, double& s) { return simplify_with(in, target, 1, s); }},
       {"2", [](const auto& in, std::size_t target, double& s) { return simplify_with(in, target, 2, s); }}});
}
