#include <algorithm>
#include <array>
#include <cmath>

#include "app/samples/noise.h"
#include "app/samples/samples.h"
#include "app/samples/surface_of_revolution.h"
#include "lodestone/math/angle.h"

namespace lodestone::app {
namespace {

// The bust's outline from the bottom up, metres: height, half width, half depth, and how far forward the middle is.
using Row = std::array<double, 4>;
constexpr Row kOutline[] = {{0.000, 0.000, 0.000, 0.000}, {0.001, 0.100, 0.100, 0.000},  {0.008, 0.112, 0.112, 0.000},
                            {0.028, 0.112, 0.112, 0.000}, {0.036, 0.100, 0.100, 0.000},  {0.050, 0.062, 0.062, 0.000},
                            {0.075, 0.048, 0.048, 0.000}, {0.095, 0.052, 0.050, 0.000},  {0.110, 0.085, 0.066, 0.000},
                            {0.140, 0.150, 0.088, 0.000}, {0.190, 0.200, 0.105, 0.004},  {0.240, 0.226, 0.112, 0.004},
                            {0.285, 0.222, 0.104, 0.000}, {0.318, 0.180, 0.086, -0.006}, {0.345, 0.104, 0.070, -0.006},
                            {0.372, 0.064, 0.060, 0.000}, {0.400, 0.055, 0.056, 0.006},  {0.428, 0.055, 0.060, 0.012},
                            {0.448, 0.056, 0.074, 0.026}, {0.480, 0.065, 0.086, 0.020},  {0.520, 0.073, 0.095, 0.012},
                            {0.560, 0.078, 0.100, 0.006}, {0.600, 0.078, 0.099, 0.002},  {0.635, 0.067, 0.085, 0.000},
                            {0.658, 0.045, 0.057, 0.000}, {0.668, 0.022, 0.028, 0.000},  {0.672, 0.000, 0.000, 0.000}};
constexpr std::size_t kRows = std::size(kOutline);

// A curve through the rows that doesn't overshoot (harmonic-mean slopes, as Fritsch and Butland 1984), by arc length.
class Outline {
 public:
  Outline() {
    for (std::size_t k = 1; k < kRows; ++k) {
      const double dx = kOutline[k][1] - kOutline[k - 1][1], dy = kOutline[k][0] - kOutline[k - 1][0];
      at_[k] = at_[k - 1] + std::sqrt(dx * dx + dy * dy);
    }
    for (std::size_t k = 1; k + 1 < kRows; ++k) {
      for (std::size_t c = 0; c < 4; ++c) slope_[k][c] = mean_slope(chord(k, c), chord(k + 1, c));
    }
    for (std::size_t c = 0; c < 4; ++c) {  // flat at both poles, as round things are
      slope_[0][c] = c == 0 ? 0 : chord(1, c);
      slope_[kRows - 1][c] = c == 0 ? 0 : chord(kRows - 1, c);
    }
  }
  double length() const { return at_[kRows - 1]; }

  Row at(double place) const {
    const double s = std::clamp(place, 0.0, 1.0) * length();
    const auto upper = std::upper_bound(at_.begin() + 1, at_.end() - 1, s);
    const auto k = static_cast<std::size_t>(upper - at_.begin());
    const double h = at_[k] - at_[k - 1], t = (s - at_[k - 1]) / h;
    Row out{};
    for (std::size_t c = 0; c < 4; ++c) {
      const double a = kOutline[k - 1][c], b = kOutline[k][c];
      const double da = slope_[k - 1][c] * h, db = slope_[k][c] * h;
      out[c] = a + t * (da + t * (3 * (b - a) - 2 * da - db + t * (2 * (a - b) + da + db)));
    }
    return out;
  }

 private:
  double chord(std::size_t k, std::size_t c) const {
    return (kOutline[k][c] - kOutline[k - 1][c]) / (at_[k] - at_[k - 1]);
  }
  static double mean_slope(double a, double b) { return a * b <= 0 ? 0 : 2 * a * b / (a + b); }
  std::array<double, kRows> at_{};
  std::array<Row, kRows> slope_{};
};

// A dent or bump of the face, pushed along z; `width` and `tall` are where it ends.
struct Feature {
  double x, y, width, tall, push;
};
constexpr Feature kFace[] = {
    {0, 0.542, 0.017, 0.040, 0.016},      {0, 0.522, 0.017, 0.017, 0.013},        // nose: bridge and tip
    {0.010, 0.517, 0.012, 0.010, 0.006},  {-0.010, 0.517, 0.012, 0.010, 0.006},   // its wings
    {0.030, 0.560, 0.027, 0.017, -0.014}, {-0.030, 0.560, 0.027, 0.017, -0.014},  // eye sockets
    {0.029, 0.559, 0.016, 0.011, 0.009},  {-0.029, 0.559, 0.016, 0.011, 0.009},   // eyes
    {0.029, 0.581, 0.034, 0.012, 0.006},  {-0.029, 0.581, 0.034, 0.012, 0.006},   // brows
    {0.045, 0.527, 0.032, 0.030, 0.006},  {-0.045, 0.527, 0.032, 0.030, 0.006},   // cheekbones
    {0, 0.4935, 0.026, 0.0065, 0.007},    {0, 0.4800, 0.022, 0.0075, 0.008},      // lips
    {0, 0.4870, 0.028, 0.0040, -0.005},   {0, 0.5030, 0.006, 0.0080, -0.002},     // mouth, groove above it
    {0, 0.4570, 0.024, 0.0180, 0.012}};                                           // chin

double bump(double dx, double dy) {
  const double d = 1 - dx * dx - dy * dy;
  return d <= 0 ? 0 : d * d * d;
}

double face_push(Vec3d p) {
  double push = 0;
  for (const Feature& f : kFace) push += f.push * bump((p.x - f.x) / f.width, (p.y - f.y) / f.tall);
  return push;
}

// How much of the hair covers a point: above a line that falls from the forehead to the nape.
double hair_cover(Vec3d p, double front) {
  const double line = 0.470 + 0.136 * smooth_step(-0.25, 0.65, front);
  return smooth_step(line - 0.006, line + 0.006, p.y);
}

Vec3d sculpted(Vec3d p, Vec3d outward, double front, std::uint64_t seed) {
  const double head = smooth_step(0.43, 0.46, p.y), body = smooth_step(0.10, 0.13, p.y);
  const double cloth = smooth_step(0.11, 0.15, p.y) * (1 - smooth_step(0.33, 0.36, p.y));
  double push = 0.0045 * body * gradient_noise(p * 9.0, seed + 10);  // no head is symmetric
  const double hair = hair_cover(p, front) * head;
  if (hair > 0) {
    const Vec3d strands{p.x * 95, p.y * 34, p.z * 95};
    push += hair * (0.006 + 0.008 * ridged_noise(strands, 3, 0.5, seed + 20));
  }
  if (cloth > 0) {
    const Vec3d folds{p.x * 16 + p.y * 5, p.y * 5, p.z * 16};
    push += cloth * 0.013 * (ridged_noise(folds, 2, 0.4, seed + 30) - 0.6);
  }
  const double ear_y = (p.y - 0.545) / 0.034, ear_z = (p.z - 0.004) / 0.021;
  const double ear = 0.020 * bump(ear_z, ear_y) - 0.013 * bump(ear_z * 1.9, ear_y * 1.7);
  const double side = p.x < 0 ? -1 : 1;
  // Chisel marks and the noise of a scanner, down to a millimetre.
  push += body * 0.0011 * fractal_noise(p * 60.0, 5, 0.55, seed + 40) + 0.00012 * gradient_noise(p * 900.0, seed + 50);
  return p + outward * push +
         Vec3d{side * ear * (1 - hair * 0.6), 0, front > 0 ? face_push(p) * smooth_step(0, 0.25, front) : 0};
}

}  // namespace

Model make_statue(std::size_t triangles, std::uint64_t seed, const Task& task) {
  const Outline outline;
  const RevolutionProfile profile{[&](double place) {
                                    const Row row = outline.at(place);
                                    return 2 * kPi * std::sqrt((row[1] * row[1] + row[2] * row[2]) / 2);
                                  },
                                  outline.length()};
  const RingSurface surface = [&](double place, double turns) {
    const Row row = outline.at(place), below = outline.at(place - 1e-3), above = outline.at(place + 1e-3);
    const SinCos angle = sin_cos_degrees(360 * turns);
    const Vec3d p{row[1] * angle.sin, row[0], row[3] + row[2] * angle.cos};
    const double rise = above[0] - below[0], widen = (above[1] + above[2] - below[1] - below[2]) / 2;
    const Vec3d outward = normalized(Vec3d{angle.sin * rise, -widen, angle.cos * rise});
    return sculpted(p, outward, angle.cos, seed);
  };
  Mesh mesh = stack_rings(plan_rings(triangles, profile), surface, task);
  mesh.name = "statue";
  Model model = make_model(std::move(mesh));
  model.meters_per_unit = 1;
  return model;
}

}  // namespace lodestone::app
