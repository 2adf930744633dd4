// How fast two-sided measuring is (samples a second, both directions counted), trees built anew each time or once.
//   measure_bench MESH LEVEL [--benchmark_…]
#include <benchmark/benchmark.h>

#include <cstdio>

#include "lodestone/base/parallel.h"
#include "lodestone/io/read.h"
#include "lodestone/measure/distance.h"

namespace {

using namespace lodestone;

void measure_levels(benchmark::State& state, const Model& a, const Model& b, std::uint64_t samples, int threads) {
  const ThreadLimit limit(threads);
  const Task task = Task::root({}, threads);
  measure::DistanceOptions options;
  options.samples = samples;
  options.bound = false;
  for ([[maybe_unused]] const auto& turn : state) {
    const auto reference = measure::Reference::create(a, task);
    benchmark::DoNotOptimize(reference->distance_to(b, options, task));
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(2 * samples));
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc != 3) {
    std::fputs("usage: measure_bench MESH LEVEL [--benchmark_…]\n", stderr);
    return 2;
  }
  const Result<Model> a = io::read_model(argv[1]), b = io::read_model(argv[2]);
  if (!a || !b) {
    std::fprintf(stderr, "measure_bench: %s\n", (a ? b : a).error().what.c_str());
    return 1;
  }
  for (const std::uint64_t samples : {std::uint64_t{200'000}, std::uint64_t{2'000'000}}) {
    for (const int threads : {1, 2}) {
      benchmark::RegisterBenchmark(
          ("samples:" + std::to_string(samples) + "/threads:" + std::to_string(threads)).c_str(),
          [&, samples, threads](benchmark::State& state) { measure_levels(state, *a, *b, samples, threads); })
          ->UseRealTime()
          ->Unit(benchmark::kMillisecond);
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
