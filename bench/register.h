// How the benchmarks that differ in threads are named and timed.
#pragma once

#include <benchmark/benchmark.h>

#include <string>

/// Runs body(state) as "NAME/threads:N", in wall time, milliseconds.
template <class Body>
void add(const std::string& name, int threads, Body body) {
  benchmark::RegisterBenchmark((name + "/threads:" + std::to_string(threads)).c_str(), body)
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}
