// How fast files are read (megabytes of file a second, page cache warm).
//   read_bench FILE… [--benchmark_…]
#include <benchmark/benchmark.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/io/read.h"

namespace {

void read_file(benchmark::State& state, const std::string& path) {
  const lodestone::ThreadLimit limit(2);
  for ([[maybe_unused]] const auto& turn : state) {
    const lodestone::Result<lodestone::Model> model = lodestone::io::read_model(path);
    if (!model) {
      state.SkipWithError(model.error().what.c_str());
      break;
    }
    benchmark::DoNotOptimize(model->meshes.data());
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * std::filesystem::file_size(path)));
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc < 2) {
    std::fputs("usage: read_bench FILE… [--benchmark_…]\n", stderr);
    return 2;
  }
  for (int i = 1; i < argc; ++i) {
    const std::string path = argv[i];
    benchmark::RegisterBenchmark(std::filesystem::path(path).filename().c_str(),
                                 [path](benchmark::State& state) { read_file(state, path); })
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
