// How fast edge collapse is (input triangles a second), to 10 % and to 1 % of the triangles.
//   collapse_bench MESH… [--benchmark_…]
#include <benchmark/benchmark.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "lodestone/base/parallel.h"
#include "lodestone/io/read.h"
#include "lodestone/simplify/collapse/edge_collapse.h"

namespace {

using namespace lodestone;

void collapse(benchmark::State& state, const Mesh& mesh, std::size_t percent, int threads, bool log) {
  const ThreadLimit limit(threads);
  simplify::EdgeCollapseOptions options;
  options.target_triangles = mesh.triangles.size() * percent / 100;
  options.record_log = log;
  for ([[maybe_unused]] const auto& turn : state) {
    benchmark::DoNotOptimize(simplify::collapse_edges(mesh, options, Task::root({}, threads)));
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * mesh.triangles.size()));
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc < 2) {
    std::fputs("usage: collapse_bench MESH… [--benchmark_…]\n", stderr);
    return 2;
  }
  std::vector<Model> models;
  models.reserve(static_cast<std::size_t>(argc));
  for (int i = 1; i < argc; ++i) {
    Result<Model> model = io::read_model(argv[i]);
    if (!model) {
      std::fprintf(stderr, "collapse_bench: %s: %s\n", argv[i], model.error().what.c_str());
      return 1;
    }
    models.push_back(std::move(*model));
    const Mesh& mesh = models.back().meshes[0];
    const std::string name = std::filesystem::path(argv[i]).stem().string();
    for (const std::size_t percent : {10, 1}) {
      for (const int threads : {1, 2}) {
        for (const bool log : {false, true}) {
          benchmark::RegisterBenchmark(
              (name + "/" + std::to_string(percent) + "%/threads:" + std::to_string(threads) + (log ? "/log" : ""))
                  .c_str(),
              [&mesh, percent, threads, log](benchmark::State& state) { collapse(state, mesh, percent, threads, log); })
              ->UseRealTime()
              ->Unit(benchmark::kMillisecond);
        }
      }
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
