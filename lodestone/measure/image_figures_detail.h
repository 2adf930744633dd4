// Figures of two pictures of the same size. A picture is luminance or colour in bytes, a mask says which pixels count.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace lodestone::measure::detail {

/// Exact distance of every pixel to the nearest one that is set, pixels; infinite where none is. Source: Felzenszwalb &
/// Huttenlocher 2012. O(pixels).
std::vector<float> distances_to(std::span<const std::uint8_t> set, std::uint32_t width, std::uint32_t height);

/// Sum over the pixels where `counts` is set of the structural similarity in the window around each. O(pixels).
double sum_of_ssim(std::span<const float> a, std::span<const float> b, std::span<const std::uint8_t> counts,
                   std::uint32_t width, std::uint32_t height);

}  // namespace lodestone::measure::detail
