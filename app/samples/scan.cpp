#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "app/samples/files.h"
#include "app/samples/noise.h"
#include "app/samples/samples.h"
#include "lodestone/base/random.h"
#include "lodestone/spatial/smooth_normals.h"

namespace lodestone::app {
namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they lie in memory");

constexpr double kRoughness = 0.0001;  // of a scanner, metres

using Color = std::array<double, 3>;  // 0 to 255
constexpr Color kStone{186, 180, 170}, kSkin{214, 178, 150}, kHair{92, 66, 48}, kCloth{128, 58, 52};

Color mix(const Color& a, const Color& b, double t) {
  return {a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t};
}

// The bust as if it had been painted.
Color color_at(Vec3d p, std::uint64_t seed) {
  const double front = std::clamp(p.z / 0.09, -1.0, 1.0);
  const double hairline = 0.470 + 0.136 * smooth_step(-0.25, 0.65, front);
  Color color = mix(kStone, kCloth, smooth_step(0.105, 0.115, p.y));
  color = mix(color, kSkin, smooth_step(0.335, 0.345, p.y));
  color = mix(color, kHair, smooth_step(hairline - 0.006, hairline + 0.006, p.y));
  const double worn = 1 + 0.10 * fractal_noise(p * 40.0, 3, 0.5, seed + 60);
  for (double& c : color) c = std::clamp(c * worn, 0.0, 255.0);
  return color;
}

void append(std::string& out, Vec3d v) {
  for (const double x : {v.x, v.y, v.z}) {
    const auto value = static_cast<float>(x);
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    out.append(bytes, sizeof value);
  }
}

std::string header(std::size_t points) {
  return fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment A scan made by the command lod, in metres\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
      points);
}

}  // namespace

ScanSample make_scan(std::size_t points, std::uint64_t seed, const Task& task) {
  ScanSample out;
  const Model statue = make_statue(2 * points, seed, task);
  const Mesh& mesh = statue.meshes.front();
  const std::vector<Vec3d> normals = spatial::vertex_normals(mesh);
  std::string values;
  for (std::size_t v = 0; v < mesh.positions.size() && !task.cancelled(); ++v) {
    const Vec3d at = to_double(mesh.positions[v]);
    const bool stands_on_it = at.y < 0.004 && normals[v].y < -0.5;
    if (stands_on_it) continue;
    append(values, at + normals[v] * (kRoughness * (2 * random_unit(seed, v) - 1)));
    append(values, normals[v]);
    for (const double c : color_at(at, seed)) values += static_cast<char>(static_cast<unsigned char>(c));
    ++out.points;
  }
  out.ply = header(out.points) + values;
  return out;
}

}  // namespace lodestone::app
