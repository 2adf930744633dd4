// A larger mesh out of a closed one, for runs that want a model as large as a scan:
//   grow_mesh IN OUT ROUNDS [NOISE]
// Each round is one sqrt(3) subdivision (Kobbelt, sqrt(3)-subdivision, SIGGRAPH 2000): three times the triangles,
// closed and manifold as before. Then vertices move along their normals by smooth noise of at most NOISE times the
// diagonal (0.00002 without), as no scan is smooth piece by piece. The same file every time.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "app/samples/noise.h"
#include "lodestone/base/units.h"
#include "lodestone/core/adjacency.h"
#include "lodestone/core/model.h"
#include "lodestone/io/read.h"
#include "lodestone/io/write.h"

namespace {

using namespace lodestone;

constexpr double kNoise = 2e-5, kNoiseCells = 1000;  // cells along the diagonal

// Old vertices relaxed towards the mean of their neighbours. cos is not the same on every machine to the last bit,
// which does no harm here.
std::vector<Vec3f> relaxed(const Mesh& mesh, const EdgeTriangles& edges) {
  std::vector<Vec3d> sum(mesh.vertex_count());
  std::vector<std::uint32_t> degree(mesh.vertex_count(), 0);
  for (const Edge& edge : edges.edges) {
    sum[edge.a] += to_double(mesh.positions[edge.b]);
    sum[edge.b] += to_double(mesh.positions[edge.a]);
    ++degree[edge.a];
    ++degree[edge.b];
  }
  std::vector<Vec3f> out(mesh.positions);
  for (std::size_t v = 0; v < out.size(); ++v) {
    const double n = std::max(1U, degree[v]), beta = (4 - 2 * std::cos(2 * app::kPi / n)) / 9;
    out[v] = to_float(to_double(mesh.positions[v]) * (1 - beta) + sum[v] * (beta / n));
  }
  return out;
}

// Every triangle becomes three around its centre, and every old edge is flipped to join the two centres beside it.
// Nothing where an edge has not two triangles that run along it in opposite directions.
std::optional<Mesh> sqrt3_round(const Mesh& mesh) {
  const EdgeTriangles edges = edge_triangles(mesh);
  const auto centre = static_cast<std::uint32_t>(mesh.vertex_count());
  Mesh out;
  out.offset = mesh.offset;
  out.positions = relaxed(mesh, edges);
  for (const Triangle& t : mesh.triangles) {
    const Vec3d sum =
        to_double(mesh.positions[t[0]]) + to_double(mesh.positions[t[1]]) + to_double(mesh.positions[t[2]]);
    out.positions.push_back(to_float(sum / 3.0));
  }
  out.triangles.resize(3 * mesh.triangles.size());
  const auto along = [&](std::uint32_t triangle, std::uint32_t a, std::uint32_t b) -> std::optional<std::uint32_t> {
    const Triangle& t = mesh.triangles[triangle];
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (t[k] == a && t[(k + 1) % 3] == b) return k;
    }
    return std::nullopt;
  };
  for (const Edge& edge : edges.edges) {
    const auto beside = edges.of(edge);
    if (beside.size() != 2) return std::nullopt;
    const bool first_runs_up = along(beside[0], edge.a, edge.b).has_value();
    const std::uint32_t up = beside[first_runs_up ? 0 : 1], down = beside[first_runs_up ? 1 : 0];
    const auto k = along(up, edge.a, edge.b), m = along(down, edge.b, edge.a);
    if (!k || !m) return std::nullopt;
    out.triangles[3 * up + *k] = {edge.a, centre + down, centre + up};
    out.triangles[3 * down + *m] = {edge.b, centre + up, centre + down};
  }
  return out;
}

// Vertices in the order that triangles name them, so that neighbours are near in memory as in a scan.
void number_by_use(Mesh& mesh) {
  std::vector<std::uint32_t> place(mesh.vertex_count(), kNone);
  std::vector<Vec3f> positions;
  positions.reserve(mesh.vertex_count());
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) {
      if (place[v] == kNone) {
        place[v] = static_cast<std::uint32_t>(positions.size());
        positions.push_back(mesh.positions[v]);
      }
      v = place[v];
    }
  }
  mesh.positions = std::move(positions);
}

void add_noise(Mesh& mesh, double share) {
  std::vector<Vec3d> normals(mesh.vertex_count());
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = to_double(mesh.positions[t[0]]);
    const Vec3d normal = cross(to_double(mesh.positions[t[1]]) - a, to_double(mesh.positions[t[2]]) - a);
    for (const std::uint32_t v : t) normals[v] += normal;
  }
  const double diagonal = bounds_of(mesh).diagonal();
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const Vec3d p = to_double(mesh.positions[v]);
    const double size = length(normals[v]);
    if (!(size > 0)) continue;
    const double height = share * diagonal * app::gradient_noise(p * (kNoiseCells / diagonal), 1);
    mesh.positions[v] = to_float(p + normals[v] * (height / size));
  }
}

int complain(const Error& error) {
  std::fprintf(stderr, "grow_mesh: %s\n", error.line().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::optional<double> noise = argc == 5 ? parse_number(argv[4]) : kNoise;
  if (argc < 4 || argc > 5 || !noise) {
    std::fputs("usage: grow_mesh IN OUT ROUNDS [NOISE]\n", stderr);
    return 2;
  }
  Result<Model> model = io::read_model(argv[1]);
  if (!model) return complain(model.error());
  if (model->meshes.size() != 1) {
    return complain({ErrorCode::unsupported, "has not one mesh", argv[1], "convert it to .ply first"});
  }
  Mesh mesh;  // its geometry alone
  mesh.positions = model->meshes[0].positions;
  mesh.offset = model->meshes[0].offset;
  for (std::size_t t = 0; t < model->meshes[0].triangles.size(); ++t) {
    mesh.triangles.push_back(model->meshes[0].vertices_of(t));
  }
  for (int rounds = std::atoi(argv[3]); rounds > 0; --rounds) {
    std::optional<Mesh> grown = sqrt3_round(mesh);
    if (!grown) {
      return complain({ErrorCode::unsupported, "is not closed, manifold and of one orientation", argv[1],
                       "take another, or 'lod remesh' it first"});
    }
    mesh = std::move(*grown);
  }
  number_by_use(mesh);
  add_noise(mesh, *noise);
  const Result<io::WriteReport> written = io::write_model(make_model(std::move(mesh)), argv[2]);
  return written ? 0 : complain(written.error());
}
