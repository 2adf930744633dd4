#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "app/samples/files.h"
#include "app/samples/noise.h"
#include "lodestone/base/random.h"
#include "lodestone/math/vec.h"

namespace lodestone::app {
namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they lie in memory");

constexpr std::size_t kSize[3] = {96, 96, 80};
constexpr Vec3d kSpacing{1.2, 1.2, 1.5};  // mm
constexpr Vec3d kFirst{-57, -57, 0};      // of the first voxel: x to the left, y to the back, z up
constexpr double kAir = -1000, kFat = -100, kMuscle = 50, kSpongy = 450, kCortical = 1100;  // Hounsfield units

// Distances are negative inside, millimetres.
double ball(Vec3d p, Vec3d center, double radius) { return length(p - center) - radius; }

// About right near its surface, which is all that is needed.
double ellipsoid(Vec3d p, Vec3d center, Vec3d radii) {
  const Vec3d d = p - center;
  const double k = length(Vec3d{d.x / radii.x, d.y / radii.y, d.z / radii.z});
  return (k - 1) * std::min({radii.x, radii.y, radii.z});
}

// A rod from a to b whose radius changes along it.
double rod(Vec3d p, Vec3d a, Vec3d b, double radius_a, double radius_b) {
  const Vec3d along = b - a;
  const double t = std::clamp(dot(p - a, along) / dot(along, along), 0.0, 1.0);
  return length(p - a - along * t) - (radius_a + (radius_b - radius_a) * t);
}

// The union of both, rounded where they meet.
double joined(double a, double b, double round) {
  const double h = std::clamp(0.5 + 0.5 * (b - a) / round, 0.0, 1.0);
  return b + (a - b) * h - round * h * (1 - h);
}

double femur(Vec3d p) {
  const double shaft = rod(p, {0, -2, 130}, {0, 0, 78}, 11, 17);
  const double condyles = std::min(ball(p, {-20, 5, 72}, 18), ball(p, {20, 5, 72}, 17));
  return joined(shaft, condyles, 14);
}

double tibia(Vec3d p) {
  const double shaft = rod(p, {0, 0, -10}, {0, 2, 34}, 11, 16);
  return joined(shaft, ellipsoid(p, {0, 4, 40}, {32, 22, 10}), 12);
}

double bones(Vec3d p) {
  const double fibula = rod(p, {31, 23, -10}, {30, 22, 23}, 4.5, 6.5);
  const double patella = ellipsoid(p, {0, -31, 76}, {19, 8, 20});
  return std::min({femur(p), tibia(p), fibula, patella});
}

double leg(Vec3d p) {
  const double knee = smooth_step(0, 60, p.z) * (1 - smooth_step(60, 130, p.z));
  const double x = p.x / (48 + 2 * knee), y = (p.y - 1 + 3 * knee) / (45 + 4 * knee);
  return (std::sqrt(x * x + y * y) - 1) * 45;
}

// From `outside` to `inside` over about two voxels: one that a surface cuts is a mix of both.
double mixed(double outside, double inside, double distance) {
  return outside + (inside - outside) * std::clamp(0.5 - distance / 2.4, 0.0, 1.0);
}

double hounsfield(Vec3d p, std::uint64_t seed) {
  const double skin = leg(p) + 0.8 * gradient_noise(p * 0.05, seed);
  double value = mixed(kAir, kFat, skin);
  value = mixed(value, kMuscle + 25 * gradient_noise(p * 0.12, seed + 1), skin + 6);
  const double bone = bones(p) + 0.5 * fractal_noise(p * 0.15, 3, 0.5, seed + 2);
  value = mixed(value, kCortical, bone);
  return mixed(value, kSpongy + 60 * fractal_noise(p * 0.5, 2, 0.6, seed + 3), bone + 2.5);
}

std::string header() {
  return fmt::format(
      "NRRD0004\n# A knee made by the command lod, no patient\ntype: int16\ndimension: 3\nsizes: {} {} {}\n"
      "space: left-posterior-superior\nspace directions: ({},0,0) (0,{},0) (0,0,{})\nspace origin: ({},{},{})\n"
      "endian: little\nencoding: raw\n\n",
      kSize[0], kSize[1], kSize[2], kSpacing.x, kSpacing.y, kSpacing.z, kFirst.x, kFirst.y, kFirst.z);
}

}  // namespace

CtSample make_ct(std::uint64_t seed, const Task& task) {
  CtSample out;
  std::copy(std::begin(kSize), std::end(kSize), out.size.begin());
  out.nrrd = header();
  std::uint64_t voxel = 0;
  for (std::size_t z = 0; z < kSize[2] && !task.cancelled(); ++z) {
    for (std::size_t y = 0; y < kSize[1]; ++y) {
      for (std::size_t x = 0; x < kSize[0]; ++x, ++voxel) {
        const Vec3d p = kFirst + Vec3d{static_cast<double>(x) * kSpacing.x, static_cast<double>(y) * kSpacing.y,
                                       static_cast<double>(z) * kSpacing.z};
        const double grain = 30 * (random_unit(seed, 2 * voxel) + random_unit(seed, 2 * voxel + 1) - 1);
        const auto value = static_cast<std::int16_t>(std::clamp(hounsfield(p, seed) + grain, -1024.0, 3071.0));
        char bytes[sizeof value];
        std::memcpy(bytes, &value, sizeof value);
        out.nrrd.append(bytes, sizeof value);
      }
    }
    task.advance(1.0 / static_cast<double>(kSize[2]));
  }
  return out;
}

}  // namespace lodestone::app
