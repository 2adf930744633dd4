#include "bench/peers/peer.h"

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else
#define CALLGRIND_START_INSTRUMENTATION
#define CALLGRIND_STOP_INSTRUMENTATION
#endif

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>

#include "lodestone/io/read.h"
#include "lodestone/io/write.h"

namespace peers {

namespace {

using namespace lodestone;

Triangles flat(const Mesh& mesh) {
  Triangles out;
  for (const Vec3f& p : mesh.positions) out.positions.insert(out.positions.end(), {p.x, p.y, p.z});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.vertices_of(t)) out.indices.push_back(v);
  }
  return out;
}

Model to_model(const Triangles& in) {
  Mesh mesh;
  for (std::size_t v = 0; v < in.vertices(); ++v) {
    mesh.positions.push_back({in.positions[3 * v], in.positions[3 * v + 1], in.positions[3 * v + 2]});
  }
  for (std::size_t t = 0; t < in.triangles(); ++t) {
    mesh.triangles.push_back({in.indices[3 * t], in.indices[3 * t + 1], in.indices[3 * t + 2]});
  }
  return make_model(std::move(mesh));
}

int fail_with(const std::string& what) {
  std::fprintf(stderr, "%s\n", what.c_str());
  return 1;
}

}  // namespace

double now_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void count_instructions(bool on) {
  if (on) {
    CALLGRIND_START_INSTRUMENTATION;
  } else {
    CALLGRIND_STOP_INSTRUMENTATION;
  }
}

int run(int argc, char** argv, const std::vector<NamedMethod>& methods) {
  if (argc != 6) return fail_with("usage: PROGRAM METHOD MESH TARGET_TRIANGLES OUT.ply REPEATS");
  const auto method =
      std::find_if(methods.begin(), methods.end(), [&](const NamedMethod& m) { return m.name == argv[1]; });
  if (method == methods.end()) return fail_with(std::string("no method ") + argv[1]);
  const Result<Model> model = io::read_model(argv[2]);
  if (!model) return fail_with(model.error().line());
  const Triangles in = flat(model->meshes[0]);
  const std::size_t target = std::strtoull(argv[3], nullptr, 10);
  double best = std::numeric_limits<double>::infinity();
  Triangles out;
  try {
    for (int i = 0; i < std::max(1, std::atoi(argv[5])); ++i) {
      double seconds = 0;
      out = method->run(in, target, seconds);
      best = std::min(best, seconds);
    }
  } catch (const std::exception& e) {
    return fail_with(e.what());
  }
  if (const auto written = io::write_model(to_model(out), argv[4]); !written) return fail_with(written.error().line());
  std::printf("%.6f\n", best);
  return 0;
}

}  // namespace peers
