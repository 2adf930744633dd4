// Noise and angles for the samples, with + - * / and sqrt only: the same bits on every machine.
#pragma once

#include <cstdint>

#include "lodestone/math/vec.h"

namespace lodestone::app {

/// Smooth noise in about [-1, 1] with details of about 1 unit (Perlin 2002, "Improving noise"). Continuous derivatives.
double gradient_noise(Vec3d p, std::uint64_t seed);

/// `octaves` of gradient_noise, each of half the size and `gain` times the height of the one before.
double fractal_noise(Vec3d p, int octaves, double gain, std::uint64_t seed);

/// As fractal_noise, but folded so that its zero lines become sharp ridges; in [0, 1].
double ridged_noise(Vec3d p, int octaves, double gain, std::uint64_t seed);

inline constexpr double kPi = 3.14159265358979323846;

/// 0 below `from`, 1 above `to`, smooth between.
double smooth_step(double from, double to, double x);

}  // namespace lodestone::app
