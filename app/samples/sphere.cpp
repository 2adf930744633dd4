#include <array>

#include "app/samples/noise.h"
#include "app/samples/samples.h"
#include "app/samples/surface_of_revolution.h"
#include "lodestone/math/angle.h"

namespace lodestone::app {
namespace {

Mesh icosahedron() {
  const double golden = (1 + std::sqrt(5.0)) / 2;
  Mesh mesh;
  for (const Vec3d p : {Vec3d{-1, golden, 0}, Vec3d{1, golden, 0}, Vec3d{-1, -golden, 0}, Vec3d{1, -golden, 0},
                        Vec3d{0, -1, golden}, Vec3d{0, 1, golden}, Vec3d{0, -1, -golden}, Vec3d{0, 1, -golden},
                        Vec3d{golden, 0, -1}, Vec3d{golden, 0, 1}, Vec3d{-golden, 0, -1}, Vec3d{-golden, 0, 1}}) {
    mesh.positions.push_back(to_float(normalized(p)));
  }
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return mesh;
}

// The middle vertex of each edge, made when it is first asked for; edges hang in lists at their lower vertex.
class Middles {
 public:
  explicit Middles(Mesh& mesh) : mesh_(mesh), head_(mesh.positions.size(), kNone) {
    entries_.reserve(mesh.triangles.size() * 3 / 2);
  }
  std::uint32_t of(std::uint32_t a, std::uint32_t b) {
    if (a > b) std::swap(a, b);
    for (std::uint32_t e = head_[a]; e != kNone; e = entries_[e].next) {
      if (entries_[e].other == b) return entries_[e].middle;
    }
    const auto middle = static_cast<std::uint32_t>(mesh_.positions.size());
    mesh_.positions.push_back(to_float(normalized(to_double(mesh_.positions[a]) + to_double(mesh_.positions[b]))));
    entries_.push_back(Entry{b, middle, head_[a]});
    head_[a] = static_cast<std::uint32_t>(entries_.size() - 1);
    return middle;
  }

 private:
  struct Entry {
    std::uint32_t other, middle, next;
  };
  Mesh& mesh_;
  std::vector<std::uint32_t> head_;
  std::vector<Entry> entries_;
};

void subdivide(Mesh& mesh, const Task& task) {
  Middles middles(mesh);
  std::vector<Triangle> finer;
  finer.reserve(mesh.triangles.size() * 4);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (i % 65536 == 0 && task.cancelled()) return;
    const Triangle& t = mesh.triangles[i];
    const std::uint32_t a = middles.of(t[0], t[1]), b = middles.of(t[1], t[2]), c = middles.of(t[2], t[0]);
    finer.insert(finer.end(), {Triangle{t[0], a, c}, Triangle{t[1], b, a}, Triangle{t[2], c, b}, Triangle{a, b, c}});
  }
  mesh.triangles = std::move(finer);
}

}  // namespace

Model make_icosphere(int level, const Task& task) {
  Mesh mesh = icosahedron();
  for (int i = 0; i < level && !task.cancelled(); ++i) subdivide(mesh, task);
  mesh.name = "sphere";
  return make_model(std::move(mesh));
}

Model make_sphere(std::size_t triangles, const Task& task) {
  // Places are shares of the half circle from the lower to the upper pole.
  const RevolutionProfile profile{[](double place) { return 2 * kPi * sin_cos_degrees(180 * place).sin; }, kPi};
  const RingSurface surface = [](double place, double turns) {
    const SinCos height = sin_cos_degrees(180 * place), around = sin_cos_degrees(360 * turns);
    return Vec3d{height.sin * around.sin, -height.cos, height.sin * around.cos};
  };
  Mesh mesh = stack_rings(plan_rings(triangles, profile), surface, task);
  mesh.name = "sphere";
  return make_model(std::move(mesh));
}

}  // namespace lodestone::app
