// Tables 3-1 to 3-6 of [voxel-lod] with its resolutions, by its method (EdgeRatio on one solid) and by ours (shares of
// voxels, Marching Cubes, vertices on the model), with the error that it does not give.
//   paper_voxel SPHERE COW BUDDHA DRAGON STATUE      prints Markdown; one thread, medians of five
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/base/stopwatch.h"
#include "lodestone/base/units.h"
#include "lodestone/io/read.h"
#include "lodestone/measure/distance.h"
#include "lodestone/spatial/bvh.h"
#include "lodestone/voxel/edge_ratio.h"
#include "lodestone/voxel/isosurface.h"
#include "lodestone/voxel/project.h"
#include "lodestone/voxel/resample.h"
#include "lodestone/voxel/voxelize.h"

namespace {

using namespace lodestone;

struct Row {
  const char* table;
  int model;
  std::uint32_t voxels, samples;
  int faces_in, faces;
  double voxel_ms, mesh_ms;  // the paper's
};

constexpr Row kRows[] = {
    {"3-1", 0, 200, 20, 2401, 3740, 16.11, 14.67},         {"3-1", 1, 200, 20, 8627, 3344, 19.91, 13.08},
    {"3-1", 2, 200, 20, 61'892, 3976, 37.89, 14.84},       {"3-1", 3, 200, 20, 100'001, 3988, 56.71, 15.27},
    {"3-1", 4, 200, 20, 499'059, 2632, 91.62, 10.91},      {"3-2", 2, 50, 50, 61'892, 27'080, 10.17, 68.77},
    {"3-2", 2, 100, 50, 61'892, 27'276, 18.93, 76.26},     {"3-2", 2, 150, 50, 61'892, 27'252, 29.02, 84.44},
    {"3-2", 2, 200, 50, 61'892, 27'228, 42.88, 92.33},     {"3-2", 2, 300, 50, 61'892, 27'160, 73.05, 104.83},
    {"3-2", 2, 500, 50, 61'892, 27'068, 151.84, 132.29},   {"3-3", 1, 50, 20, 8627, 3548, 23.73, 6.72},
    {"3-3", 1, 100, 20, 8627, 3384, 27.62, 9.03},          {"3-3", 1, 150, 20, 8627, 3408, 35.13, 11.88},
    {"3-3", 1, 200, 20, 8627, 3344, 40.04, 13.07},         {"3-3", 1, 300, 20, 8627, 3344, 60.60, 17.57},
    {"3-3", 1, 500, 20, 8627, 3340, 108.27, 28.40},        {"3-4", 4, 100, 10, 579'905, 832, 72.61, 2.71},
    {"3-4", 4, 100, 20, 579'905, 3468, 73.77, 8.96},       {"3-4", 4, 100, 30, 579'905, 8204, 71.64, 20.65},
    {"3-4", 4, 100, 50, 579'905, 23'112, 73.95, 70.66},    {"3-4", 4, 100, 100, 579'905, 95'036, 74.67, 430.61},
    {"3-5", 4, 500, 10, 579'905, 832, 278.68, 14.49},      {"3-5", 4, 500, 20, 579'905, 3496, 278.25, 30.18},
    {"3-5", 4, 500, 30, 579'905, 8096, 279.21, 51.01},     {"3-5", 4, 500, 50, 579'905, 23'232, 275.61, 120.69},
    {"3-5", 4, 500, 100, 579'905, 95'368, 277.00, 551.18}, {"3-6", 3, 300, 10, 100'001, 788, 90.13, 7.00},
    {"3-6", 3, 300, 20, 100'001, 3932, 92.63, 25.47},      {"3-6", 3, 300, 30, 100'001, 9344, 91.36, 41.00},
    {"3-6", 3, 300, 50, 100'001, 27'420, 89.11, 114.83},   {"3-6", 3, 300, 100, 100'001, 111'840, 89.87, 532.14}};
constexpr const char* kNames[] = {"sphere", "cow", "Buddha", "dragon", "statue"};

template <class Run>
double median_ms(Run&& run) {
  std::vector<double> times;
  for (int i = 0; i < 5; ++i) {
    const Stopwatch watch;
    run();
    times.push_back(watch.total() * 1e3);
  }
  std::sort(times.begin(), times.end());
  return times[2];
}

std::string error_of(const measure::Reference& reference, const Mesh& mesh) {
  const auto d = reference.distance_to(make_model(mesh));
  return fmt::format("{:.3f} / {:.2f}", 100 * d->mean / d->diagonal, 100 * d->trusted_max() / d->diagonal);
}

void print_row(const Row& row, const Model& model) {
  const auto surface = spatial::flatten(model);
  const auto reference = measure::Reference::create(model);
  const spatial::Bvh tree(*surface);
  const VoxelGrid grid = *voxel::grid_over(surface->bounds, {row.voxels, row.voxels, row.voxels});
  const std::array<std::uint32_t, 3> size{row.samples, row.samples, row.samples};
  const Task one = Task::root({}, 1);
  const auto solid = voxel::voxelize(*surface, grid, {}, one);
  const double voxel_ms = median_ms([&] { return voxel::voxelize(*surface, grid, {}, one); });
  voxel::EdgeRatioOptions paper;
  paper.from_first = true;
  paper.between_steps = false;
  const auto as_printed = voxel::edge_ratio_surface(solid->volume, size, paper, one);
  const double mesh_ms = median_ms([&] { return voxel::edge_ratio_surface(solid->volume, size, paper, one); });
  const auto by_shares = [&] {
    const auto shares = voxel::downsample(solid->volume, size, one);
    auto mesh = voxel::isosurface(*shares, {127.5}, one);
    const Vec3d s = shares->grid.spacing;
    voxel::project(*mesh, tree, std::max({s.x, s.y, s.z}), one);
    return mesh;
  };
  const auto ours = by_shares();
  const double ours_ms = median_ms(by_shares);
  const std::size_t in = surface->triangles.size();
  fmt::print("| {} | {} | {} / {} | {}, {} | {} | {} | {} | {:.1f}, {:.1f} | {:.2f}, {:.2f} | {:.2f} | {} | {} |\n",
             row.table, kNames[row.model], row.voxels, row.samples,
             with_separators(static_cast<std::uint64_t>(row.faces_in)), with_separators(in),
             with_separators(static_cast<std::uint64_t>(row.faces)), with_separators(as_printed->triangles.size()),
             with_separators(ours->triangles.size()), row.voxel_ms, row.mesh_ms, voxel_ms, mesh_ms, ours_ms,
             error_of(*reference, *as_printed), error_of(*reference, *ours));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fputs("usage: paper_voxel SPHERE COW BUDDHA DRAGON STATUE\n", stderr);
    return 2;
  }
  const ThreadLimit limit(1);
  std::vector<Model> models;
  for (int i = 1; i < argc; ++i) {
    auto model = io::read_model(argv[i]);
    if (!model) {
      std::fprintf(stderr, "%s\n", model.error().line().c_str());
      return 1;
    }
    models.push_back(std::move(*model));
  }
  fmt::print(
      "| table | model | voxels / samples a side | triangles in: paper, here | paper's faces | its way here | our way "
      "| "
      "paper's ms: solid, mesh | its way here | our way's mesh | its error, % | our error, % |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Row& row : kRows) print_row(row, models[static_cast<std::size_t>(row.model)]);
  return 0;
}
