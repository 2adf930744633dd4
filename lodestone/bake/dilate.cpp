#include <algorithm>
#include <array>

#include "lodestone/bake/dilate_detail.h"
#include "lodestone/base/parallel.h"

namespace lodestone::bake::detail {

namespace {

constexpr std::size_t kRows = 16;

// One round: reads `set` and the pixels of set texels, writes others and `now`.
void round(Pixels& pixels, const std::vector<std::uint8_t>& set, std::vector<std::uint8_t>& now, const Task& task) {
  const std::uint32_t width = pixels.width, height = pixels.height;
  parallel_for(height, kRows, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t y = begin; y < end; ++y) {
      const std::size_t y0 = y > 0 ? y - 1 : 0, y1 = std::min<std::size_t>(y + 1, height - 1);
      for (std::size_t x = 0; x < width; ++x) {
        const std::size_t i = y * width + x;
        if (set[i] != 0) continue;
        const std::size_t x0 = x > 0 ? x - 1 : 0, x1 = std::min<std::size_t>(x + 1, width - 1);
        std::array<std::uint32_t, 4> sum{};
        std::uint32_t count = 0;
        for (std::size_t v = y0; v <= y1; ++v) {
          for (std::size_t u = x0; u <= x1; ++u) {
            const std::size_t j = v * width + u;
            if (set[j] == 0) continue;
            for (std::size_t k = 0; k < 4; ++k) sum[k] += pixels.rgba[4 * j + k];
            ++count;
          }
        }
        if (count == 0) continue;
        for (std::size_t k = 0; k < 4; ++k) {
          pixels.rgba[4 * i + k] = static_cast<std::uint8_t>((sum[k] + count / 2) / count);
        }
        now[i] = 1;
      }
    }
  });
}

}  // namespace

void dilate(Pixels& pixels, std::vector<std::uint8_t> set, std::uint32_t rounds, std::array<std::uint8_t, 4> rest,
            const Task& task) {
  std::vector<std::uint8_t> now = set;
  for (std::uint32_t r = 0; r < rounds && !task.cancelled(); ++r) {
    round(pixels, set, now, task);
    set = now;
  }
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (set[i] == 0) std::copy(rest.begin(), rest.end(), pixels.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
  }
}

std::array<std::uint8_t, 4> mean_of(const Pixels& pixels, const std::vector<std::uint8_t>& set) {
  std::array<std::uint64_t, 4> sum{};
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (set[i] == 0) continue;
    for (std::size_t k = 0; k < 4; ++k) sum[k] += pixels.rgba[4 * i + k];
    ++count;
  }
  if (count == 0) return {128, 128, 128, 255};
  std::array<std::uint8_t, 4> mean{};
  for (std::size_t k = 0; k < 4; ++k) mean[k] = static_cast<std::uint8_t>((sum[k] + count / 2) / count);
  return mean;
}

}  // namespace lodestone::bake::detail
