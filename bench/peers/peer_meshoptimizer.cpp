// meshoptimizer 0.18, meshopt_simplify.
#include <meshoptimizer.h>

#include <cfloat>

#include "bench/peers/peer.h"

namespace {

peers::Triangles simplify(const peers::Triangles& in, std::size_t target, double& seconds) {
  peers::Triangles out;
  out.positions = in.positions;
  out.indices.resize(in.indices.size());
  std::size_t count = 0;
  seconds = peers::seconds_of([&] {
    count = meshopt_simplify(out.indices.data(), in.indices.data(), in.indices.size(), in.positions.data(),
                             in.vertices(), 3 * sizeof(float), 3 * target, FLT_MAX, 0, nullptr);
  });
  out.indices.resize(count);
  return out;
}

}  // namespace

int main(int argc, char** argv) { return peers::run(argc, argv, {{"simplify", simplify}}); }
