// VTK 9: vtkQuadricDecimation.
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>

#include "bench/peers/peer.h"

namespace {

peers::Triangles quadric(const peers::Triangles& in, std::size_t target, double& seconds) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  for (std::size_t v = 0; v < in.vertices(); ++v) points->InsertNextPoint(in.positions.data() + 3 * v);
  vtkNew<vtkCellArray> cells;
  for (std::size_t t = 0; t < in.triangles(); ++t) {
    cells->InsertNextCell({static_cast<vtkIdType>(in.indices[3 * t]), static_cast<vtkIdType>(in.indices[3 * t + 1]),
                           static_cast<vtkIdType>(in.indices[3 * t + 2])});
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  vtkNew<vtkQuadricDecimation> decimation;
  decimation->SetInputData(data);
  decimation->SetTargetReduction(1 - static_cast<double>(target) / static_cast<double>(in.triangles()));
  seconds = peers::seconds_of([&] { decimation->Update(); });
  vtkPolyData* result = decimation->GetOutput();
  peers::Triangles out;
  for (vtkIdType v = 0; v < result->GetNumberOfPoints(); ++v) {
    double p[3];
    result->GetPoint(v, p);
    for (const double x : p) out.positions.push_back(static_cast<float>(x));
  }
  vtkCellArray* polys = result->GetPolys();
  vtkNew<vtkIdList> ids;
  for (polys->InitTraversal(); polys->GetNextCell(ids) != 0;) {
    for (vtkIdType k = 0; k < 3; ++k) out.indices.push_back(static_cast<std::uint32_t>(ids->GetId(k)));
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) { return peers::run(argc, argv, {{"quadric", quadric}}); }
