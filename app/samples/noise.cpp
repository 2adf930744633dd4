#include "app/samples/noise.h"

#include <cstdint>

#include "lodestone/base/random.h"

namespace lodestone::app {
namespace {

std::int64_t floor_of(double x) {
  const auto whole = static_cast<std::int64_t>(x);
  return static_cast<double>(whole) > x ? whole - 1 : whole;
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }
double mix(double a, double b, double t) { return a + (b - a) * t; }

// Dot product of `d` with the gradient of a lattice point: one of the 12 directions to a cube's edges.
double corner(std::int64_t x, std::int64_t y, std::int64_t z, Vec3d d, std::uint64_t seed) {
  const std::uint64_t place = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ULL ^
                              static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fULL ^
                              static_cast<std::uint64_t>(z) * 0x165667b19e3779f9ULL;
  const std::uint64_t bits = random_bits(seed, place);
  const double a = (bits & 1) != 0 ? 1 : -1, b = (bits & 2) != 0 ? 1 : -1;
  switch ((bits >> 2) % 3) {
    case 0:
      return a * d.x + b * d.y;
    case 1:
      return a * d.x + b * d.z;
    default:
      return a * d.y + b * d.z;
  }
}

}  // namespace

double gradient_noise(Vec3d p, std::uint64_t seed) {
  const std::int64_t x = floor_of(p.x), y = floor_of(p.y), z = floor_of(p.z);
  const Vec3d f{p.x - static_cast<double>(x), p.y - static_cast<double>(y), p.z - static_cast<double>(z)};
  const auto at = [&](int i, int j, int k) {
    return corner(x + i, y + j, z + k, f - Vec3d{double(i), double(j), double(k)}, seed);
  };
  const double u = fade(f.x), v = fade(f.y), w = fade(f.z);
  const double low = mix(mix(at(0, 0, 0), at(1, 0, 0), u), mix(at(0, 1, 0), at(1, 1, 0), u), v);
  const double high = mix(mix(at(0, 0, 1), at(1, 0, 1), u), mix(at(0, 1, 1), at(1, 1, 1), u), v);
  return mix(low, high, w);
}

double fractal_noise(Vec3d p, int octaves, double gain, std::uint64_t seed) {
  double sum = 0, height = 1;
  for (int i = 0; i < octaves; ++i) {
    sum += height * gradient_noise(p, seed + static_cast<std::uint64_t>(i));
    height *= gain;
    p = p * 2.0 + Vec3d{0.37, 0.11, 0.73};  // so that the octaves' lattice points don't coincide
  }
  return sum;
}

double ridged_noise(Vec3d p, int octaves, double gain, std::uint64_t seed) {
  double sum = 0, height = 1, total = 0;
  for (int i = 0; i < octaves; ++i) {
    const double n = gradient_noise(p, seed + static_cast<std::uint64_t>(i));
    const double fold = 1 - (n < 0 ? -n : n);
    sum += height * fold * fold;
    total += height;
    height *= gain;
    p = p * 2.0 + Vec3d{0.37, 0.11, 0.73};
  }
  return sum / total;
}

double smooth_step(double from, double to, double x) {
  const double t = x <= from ? 0 : x >= to ? 1 : (x - from) / (to - from);
  return t * t * (3 - 2 * t);
}

}  // namespace lodestone::app
