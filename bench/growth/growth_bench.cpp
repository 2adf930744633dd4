// One point of the curve that bench/growth/run draws:
//   growth_bench TRIANGLES THREADS
// makes the statue of `lod sample statue` with that many triangles, collapses its edges to 10 % and prints one JSON
// object with what that took: seconds, and how many bytes were resident before and at most during the call.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>

#include "app/samples/samples.h"
#include "lodestone/base/parallel.h"
#include "lodestone/base/stopwatch.h"
#include "lodestone/simplify/collapse/edge_collapse.h"

namespace {

using namespace lodestone;

// A line of /proc/self/status such as "VmHWM:  123 kB", in bytes.
std::size_t memory_status(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::size_t kilobytes = 0;
    if (word == name + ":" && status >> kilobytes) return kilobytes * 1024;
  }
  return 0;
}

// Sets VmHWM back to what is resident now: the making of the mesh shall not count. False = the kernel can't.
bool forget_peak() {
  std::ofstream file("/proc/self/clear_refs");
  file << "5" << std::flush;
  return file.good();
}

// Of all threads.
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::size_t bytes_of(const Mesh& mesh) {
  return mesh.positions.size() * sizeof(Vec3f) + mesh.triangles.size() * sizeof(Triangle);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: growth_bench TRIANGLES THREADS\n", stderr);
    return 2;
  }
  const int threads = std::max(1, std::atoi(argv[2]));
  const ThreadLimit limit(threads);
  const Model model = app::make_statue(std::strtoull(argv[1], nullptr, 10), 0, {});
  const Mesh& mesh = model.meshes[0];
  simplify::EdgeCollapseOptions options;
  options.target_triangles = mesh.triangles.size() / 10;

  if (!forget_peak()) std::fputs("growth_bench: the peak counts the making of the mesh, too\n", stderr);
  const std::size_t before = memory_status("VmRSS");
  const double processor_before = processor_seconds();
  Stopwatch watch;
  const Result<simplify::EdgeCollapseResult> result = simplify::collapse_edges(mesh, options, Task::root({}, threads));
  const double seconds = watch.total(), processor = processor_seconds() - processor_before;
  if (!result) {
    std::fprintf(stderr, "growth_bench: %s\n", result.error().line().c_str());
    return 1;
  }
  std::printf(
      "{\"triangles\": %zu, \"threads\": %d, \"seconds\": %.6f, \"processor_seconds\": %.6f, \"left\": %zu, "
      "\"input_bytes\": %zu, \"resident_before\": %zu, \"peak\": %zu}\n",
      mesh.triangles.size(), threads, seconds, processor, result->mesh.triangles.size(), bytes_of(mesh), before,
      memory_status("VmHWM"));
  return 0;
}
