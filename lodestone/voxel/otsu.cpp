#include "lodestone/voxel/otsu.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

namespace lodestone::voxel {

namespace {
constexpr std::size_t kBins = 1024;
}

double otsu_threshold(const VolumeValues& values, double least, double most) {
  std::vector<std::uint64_t> bins(kBins, 0);
  const double scale = kBins / (most - least);
  std::visit(
      [&](const auto& all) {
        for (const auto v : all) {
          const double at = (static_cast<double>(v) - least) * scale;
          if (at >= 0) ++bins[std::min(static_cast<std::size_t>(at), kBins - 1)];  // not for NaN
        }
      },
      values);
  double count = 0, sum = 0;
  for (std::size_t b = 0; b < kBins; ++b) {
    count += static_cast<double>(bins[b]);
    sum += static_cast<double>(bins[b]) * static_cast<double>(b);
  }
  double below = 0, below_sum = 0, best = -1;
  std::size_t cut = kBins / 2;
  for (std::size_t b = 0; b + 1 < kBins; ++b) {
    below += static_cast<double>(bins[b]);
    below_sum += static_cast<double>(bins[b]) * static_cast<double>(b);
    const double above = count - below;
    if (!(below > 0) || !(above > 0)) continue;
    const double gap = below_sum / below - (sum - below_sum) / above;
    const double between = below * above * gap * gap;
    if (between > best) {
      best = between;
      cut = b;
    }
  }
  return least + (static_cast<double>(cut) + 1) / scale;
}

}  // namespace lodestone::voxel
