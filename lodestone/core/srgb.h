// Light and how pictures store it (sRGB, IEC 61966-2-1), the same bits on every machine.
#pragma once

#include <cstdint>

namespace lodestone {

/// Light of an sRGB value in [0, 1].
double light_of_srgb(double srgb);

/// Light in [0, 1] of a byte of a picture. From a table.
double light_of_byte(std::uint8_t byte);

/// The byte whose light, as sRGB measures, is nearest; light is cut to [0, 1], NaN is 0. Eight comparisons.
std::uint8_t byte_of_light(double light);

}  // namespace lodestone
