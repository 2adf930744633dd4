// How fast pictures are drawn (triangles a second) from a scene made ready before; and how long that takes.
//   render_bench MESH… [--benchmark_…]
#include <benchmark/benchmark.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "bench/register.h"
#include "lodestone/base/parallel.h"
#include "lodestone/io/images/decode.h"
#include "lodestone/io/read.h"
#include "lodestone/render/render.h"

namespace {

using namespace lodestone;

constexpr double kAspect = 1280.0 / 720;

void prepare(benchmark::State& state, const Model& model, int threads) {
  const ThreadLimit limit(threads);
  for ([[maybe_unused]] const auto& turn : state) {
    benchmark::DoNotOptimize(render::Scene::create(model, {}, Task::root({}, threads)));
  }
}

void draw(benchmark::State& state, const render::Scene& scene, const render::RenderOptions& options, int threads) {
  const ThreadLimit limit(threads);
  const Camera camera = scene.framed({20, 15}, kAspect);
  for ([[maybe_unused]] const auto& turn : state) {
    benchmark::DoNotOptimize(render::render(scene, camera, options, Task::root({}, threads)));
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * scene.triangle_count()));
}

void frame(benchmark::State& state, const render::Scene& scene, int threads) {
  const ThreadLimit limit(threads);
  const Camera camera = scene.framed({20, 15}, kAspect);
  for ([[maybe_unused]] const auto& turn : state) {
    benchmark::DoNotOptimize(render::rasterize(scene, camera, 1280, 720, 4, Task::root({}, threads)));
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * scene.triangle_count()));
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc < 2) {
    std::fputs("usage: render_bench MESH… [--benchmark_…]\n", stderr);
    return 2;
  }
  std::vector<Model> models;
  models.reserve(static_cast<std::size_t>(argc));
  for (int i = 1; i < argc; ++i) {
    Result<Model> model = io::read_model(argv[i]);
    std::vector<std::string> warnings;
    if (!model || !io::decode_base_colors(*model, warnings)) {
      std::fprintf(stderr, "render_bench: %s can't be read\n", argv[i]);
      return 1;
    }
    models.push_back(std::move(*model));
    const Model& one = models.back();
    const Result<render::Scene> scene = render::Scene::create(one);
    if (!scene) {
      std::fprintf(stderr, "render_bench: %s: %s\n", argv[i], scene.error().what.c_str());
      return 1;
    }
    const std::string name = std::filesystem::path(argv[i]).stem().string();
    render::RenderOptions smooth, aliased, shown;
    aliased.samples = 1;
    shown.shading = render::default_shading(*scene);
    for (const int threads : {1, 2}) {
      add(name + "/prepare", threads, [&one, threads](benchmark::State& s) { prepare(s, one, threads); });
      add(name + "/smooth", threads, [=, scene = *scene](benchmark::State& s) { draw(s, scene, smooth, threads); });
      add(name + "/smooth/samples:1", threads,
          [=, scene = *scene](benchmark::State& s) { draw(s, scene, aliased, threads); });
      add(name + "/frame", threads, [=, scene = *scene](benchmark::State& s) { frame(s, scene, threads); });
      if (shown.shading == render::Shading::smooth) continue;
      add(name + "/as_shown", threads, [=, scene = *scene](benchmark::State& s) { draw(s, scene, shown, threads); });
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
