// Our solids and surfaces beside others', in one run:
//   voxel_peers MESH [REPEATS]
// prints Markdown. Solids of 512 voxels along the longest side: peers vtkPolyDataToImageStencil, and OpenVDB's
// meshToVolume, which makes a distance field of a narrow band, so more. Surfaces of 512³ bytes at 127.5: peers
// vtkFlyingEdges3D and vtkMarchingCubes, without normals, gradients and scalars. Medians.
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkImageStencilData.h>
#include <vtkMarchingCubes.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataToImageStencil.h>
#include <vtkUnsignedCharArray.h>
// After VTK, whose headers its macros break.
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include "bench/peers/peer.h"
#include "lodestone/base/parallel.h"
#include "lodestone/io/read.h"
#include "lodestone/spatial/surface.h"
#include "lodestone/voxel/isosurface.h"
#include "lodestone/voxel/resample.h"
#include "lodestone/voxel/voxelize.h"

namespace {

using namespace lodestone;

double median_ms(int repeats, const std::function<void()>& call) {
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) times.push_back(peers::seconds_of(call) * 1e3);
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

// Ours with one thread and with two.
std::array<double, 2> our_ms(const std::function<void(const Task&)>& call) {
  std::array<double, 2> ours{};
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    ours[threads - 1] = median_ms(9, [&] { call(Task::root({}, threads)); });
  }
  return ours;
}

vtkNew<vtkPolyData> poly_of(const spatial::Surface& surface) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  for (const Vec3d& p : surface.positions) points->InsertNextPoint(p.x, p.y, p.z);
  vtkNew<vtkCellArray> cells;
  for (const Triangle& t : surface.triangles) cells->InsertNextCell({t[0], t[1], t[2]});
  vtkNew<vtkPolyData> poly;
  poly->SetPoints(points);
  poly->SetPolys(cells);
  return poly;
}

void solids(const spatial::Surface& surface, int repeats) {
  const VoxelGrid grid = *voxel::grid_around(surface.bounds, 512);
  const auto ours = our_ms([&](const Task& task) { (void)voxel::voxelize(surface, grid, {}, task); });
  const std::uint64_t inside = voxel::voxelize(surface, grid)->volume.set_count();
  const auto poly = poly_of(surface);
  std::int64_t filled = 0;
  const double vtk = median_ms(repeats, [&] {
    vtkNew<vtkPolyDataToImageStencil> stencil;
    stencil->SetInputData(poly);
    stencil->SetOutputSpacing(grid.spacing.x, grid.spacing.y, grid.spacing.z);
    const Vec3d first = grid.point({0.5, 0.5, 0.5});
    stencil->SetOutputOrigin(first.x, first.y, first.z);
    stencil->SetOutputWholeExtent(0, static_cast<int>(grid.size[0]) - 1, 0, static_cast<int>(grid.size[1]) - 1, 0,
                                  static_cast<int>(grid.size[2]) - 1);
    stencil->Update();
    filled = 0;
    vtkImageStencilData* out = stencil->GetOutput();
    for (int z = 0; z < static_cast<int>(grid.size[2]); ++z) {
      for (int y = 0; y < static_cast<int>(grid.size[1]); ++y) {
        int r1 = 0, r2 = 0, iter = 0;
        while (out->GetNextExtent(r1, r2, 0, static_cast<int>(grid.size[0]) - 1, y, z, iter)) filled += r2 - r1 + 1;
      }
    }
  });
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  for (const Vec3d& p : surface.positions) points.emplace_back(p.x, p.y, p.z);
  for (const Triangle& t : surface.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  const auto transform = openvdb::math::Transform::createLinearTransform(grid.spacing.x);
  const double vdb = median_ms(
      repeats, [&] { (void)openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(*transform, points, triangles, 1.0F); });
  std::printf(
      "| solid of 512, %zu triangles | %.1f, %.1f | VTK stencil (one thread) %.0f | %.0f times | %llu, %lld voxels "
      "inside |\n",
      surface.triangles.size(), ours[0], ours[1], vtk, vtk / ours[1], static_cast<unsigned long long>(inside),
      static_cast<long long>(filled));
  std::printf("| the same | | OpenVDB meshToVolume, band 1 (a distance field) %.0f | %.0f times | |\n", vdb,
              vdb / ours[1]);
}

void contours(const char* name, const ScalarVolume<std::uint8_t>& volume, int repeats) {
  std::size_t triangles = 0, vertices = 0;
  const auto ours = our_ms([&](const Task& task) {
    const auto mesh = voxel::isosurface(volume, {127.5}, task);
    triangles = mesh->triangles.size();
    vertices = mesh->positions.size();
  });
  vtkNew<vtkImageData> image;
  const auto& n = volume.grid.size;
  image->SetDimensions(static_cast<int>(n[0]), static_cast<int>(n[1]), static_cast<int>(n[2]));
  vtkNew<vtkUnsignedCharArray> values;
  values->SetArray(const_cast<unsigned char*>(volume.values.data()), static_cast<vtkIdType>(volume.values.size()), 1);
  image->GetPointData()->SetScalars(values);
  vtkIdType flying_triangles = 0, flying_points = 0;
  double flying[2];
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);  // of oneTBB, which VTK runs on here
    flying[threads - 1] = median_ms(repeats, [&] {
      vtkNew<vtkFlyingEdges3D> filter;
      filter->SetInputData(image);
      filter->SetValue(0, 127.5);
      filter->ComputeNormalsOff();
      filter->ComputeGradientsOff();
      filter->ComputeScalarsOff();
      filter->Update();
      flying_triangles = filter->GetOutput()->GetNumberOfCells();
      flying_points = filter->GetOutput()->GetNumberOfPoints();
    });
  }
  const double cubes = median_ms(std::min(repeats, 2), [&] {
    vtkNew<vtkMarchingCubes> filter;
    filter->SetInputData(image);
    filter->SetValue(0, 127.5);
    filter->ComputeNormalsOff();
    filter->ComputeGradientsOff();
    filter->ComputeScalarsOff();
    filter->Update();
  });
  std::printf(
      "| surface of %s, 512³ bytes | %.1f, %.1f | vtkFlyingEdges3D %.0f, %.0f (1, 2 threads) | %.1f times | %zu, %lld "
      "triangles; %zu, %lld vertices |\n",
      name, ours[0], ours[1], flying[0], flying[1], flying[1] / ours[1], triangles,
      static_cast<long long>(flying_triangles), vertices, static_cast<long long>(flying_points));
  std::printf("| the same | | vtkMarchingCubes %.0f | %.0f times | |\n", cubes, cubes / ours[1]);
}

// Sums of sines; outside along the border, as VTK leaves surfaces open there and we close them.
ScalarVolume<std::uint8_t> gyroid(std::uint32_t n, double step) {
  ScalarVolume<std::uint8_t> out{{{n, n, n}, {}, {1, 1, 1}}, {}};
  out.values.resize(out.grid.count());
  for (std::uint32_t z = 1; z + 1 < n; ++z) {
    for (std::uint32_t y = 1; y + 1 < n; ++y) {
      for (std::uint32_t x = 1; x + 1 < n; ++x) {
        const double v = std::sin(x * step) * std::cos(y * step) + std::sin(y * step) * std::cos(z * step) +
                         std::sin(z * step) * std::cos(x * step);
        out.values[out.index(x, y, z)] = static_cast<std::uint8_t>(127.5 + 40 * v);
      }
    }
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: voxel_peers MESH [REPEATS]\n", stderr);
    return 2;
  }
  const int repeats = argc > 2 ? std::atoi(argv[2]) : 3;
  openvdb::initialize();
  const auto model = io::read_model(argv[1]);
  if (!model) {
    std::fprintf(stderr, "%s\n", model.error().line().c_str());
    return 1;
  }
  const auto surface = spatial::flatten(*model);
  std::puts("| what | ours, ms (1, 2 threads) | peer, ms | peer over ours, 2 threads | counts: ours, the peer's |");
  std::puts("| --- | --- | --- | --- | --- |");
  solids(*surface, repeats);
  contours("a gyroid", gyroid(512, 0.00726), repeats);
  const VoxelGrid fine = *voxel::grid_around(surface->bounds, 1024, 2);
  const auto solid = voxel::voxelize(*surface, fine);
  ScalarVolume<std::uint8_t> padded{{{512, 512, 512}, {}, {1, 1, 1}}, {}};
  padded.values.resize(padded.grid.count());
  const auto shares = voxel::downsample(solid->volume, {fine.size[0] / 2, fine.size[1] / 2, fine.size[2] / 2});
  const auto& n = shares->grid.size;
  for (std::uint32_t z = 0; z < n[2] && z < 512; ++z) {
    for (std::uint32_t y = 0; y < n[1] && y < 512; ++y) {
      std::copy_n(shares->values.data() + shares->index(0, y, z), std::min(n[0], 512U),
                  padded.values.data() + padded.index(0, y, z));
    }
  }
  contours("the mesh", padded, repeats);
  return 0;
}
