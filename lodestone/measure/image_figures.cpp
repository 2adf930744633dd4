#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lodestone/measure/image_figures_detail.h"

namespace lodestone::measure::detail {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kRadius = 5;
constexpr double kSigma = 1.5;

// Lower envelope of parabolas: squared distances along one line, given those across it.
void along_line(std::vector<float>& f, std::vector<float>& out, std::vector<std::size_t>& root,
                std::vector<float>& from) {
  const std::size_t n = f.size();
  std::size_t count = 0;
  for (std::size_t q = 0; q < n; ++q) {
    if (f[q] == kInfinity) continue;
    const auto meets = [&](std::size_t p) {
      const auto fq = static_cast<float>(q), fp = static_cast<float>(p);
      return ((f[q] + fq * fq) - (f[p] + fp * fp)) / (2 * fq - 2 * fp);
    };
    while (count > 0 && meets(root[count - 1]) <= from[count - 1]) --count;
    from[count] = count == 0 ? -kInfinity : meets(root[count - 1]);
    root[count++] = q;
  }
  std::size_t k = 0;
  for (std::size_t q = 0; q < n; ++q) {
    if (count == 0) {
      out[q] = kInfinity;
      continue;
    }
    while (k + 1 < count && from[k + 1] < static_cast<float>(q)) ++k;
    const float d = static_cast<float>(q) - static_cast<float>(root[k]);
    out[q] = d * d + f[root[k]];
  }
}

using Plane = std::vector<float>;

std::array<float, 2 * kRadius + 1> gaussian() {
  std::array<float, 2 * kRadius + 1> weights{};
  double sum = 0;
  for (int i = -kRadius; i <= kRadius; ++i) sum += std::exp(-i * i / (2 * kSigma * kSigma));
  for (int i = -kRadius; i <= kRadius; ++i) {
    weights[static_cast<std::size_t>(i + kRadius)] = static_cast<float>(std::exp(-i * i / (2 * kSigma * kSigma)) / sum);
  }
  return weights;
}

// Both ways; beyond the border the border's values go on.
Plane blurred(const Plane& in, std::uint32_t width, std::uint32_t height) {
  static const auto weights = gaussian();
  Plane across(in.size()), out(in.size());
  const int w = static_cast<int>(width), h = static_cast<int>(height);
  const auto at = [&](int x, int y) { return static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x); };
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      float sum = 0;
      for (int i = -kRadius; i <= kRadius; ++i) {
        sum += weights[static_cast<std::size_t>(i + kRadius)] * in[at(std::clamp(x + i, 0, w - 1), y)];
      }
      across[at(x, y)] = sum;
    }
  }
  for (int i = -kRadius; i <= kRadius; ++i) {
    const float weight = weights[static_cast<std::size_t>(i + kRadius)];
    for (int y = 0; y < h; ++y) {
      const std::size_t from = at(0, std::clamp(y + i, 0, h - 1)), to = at(0, y);
      for (std::size_t x = 0; x < width; ++x) out[to + x] += weight * across[from + x];
    }
  }
  return out;
}

Plane product(std::span<const float> a, std::span<const float> b) {
  Plane out(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) out[i] = a[i] * b[i];
  return out;
}

}  // namespace

std::vector<float> distances_to(std::span<const std::uint8_t> set, std::uint32_t width, std::uint32_t height) {
  std::vector<float> squared(set.size());
  const std::size_t longest = std::max(width, height);
  std::vector<float> from(longest);
  std::vector<std::size_t> root(longest);
  std::vector<float> line(height), found(height);
  for (std::size_t x = 0; x < width; ++x) {
    for (std::size_t y = 0; y < height; ++y) line[y] = set[y * width + x] != 0 ? 0 : kInfinity;
    along_line(line, found, root, from);
    for (std::size_t y = 0; y < height; ++y) squared[y * width + x] = found[y];
  }
  line.resize(width);
  found.resize(width);
  for (std::size_t y = 0; y < height; ++y) {
    std::copy_n(squared.begin() + static_cast<std::ptrdiff_t>(y * width), width, line.begin());
    along_line(line, found, root, from);
    for (std::size_t x = 0; x < width; ++x) squared[y * width + x] = std::sqrt(found[x]);
  }
  return squared;
}

double sum_of_ssim(std::span<const float> a, std::span<const float> b, std::span<const std::uint8_t> counts,
                   std::uint32_t width, std::uint32_t height) {
  constexpr float c1 = 0.01F * 255 * 0.01F * 255, c2 = 0.03F * 255 * 0.03F * 255;
  const Plane mean_a = blurred({a.begin(), a.end()}, width, height),
              mean_b = blurred({b.begin(), b.end()}, width, height);
  const Plane aa = blurred(product(a, a), width, height), bb = blurred(product(b, b), width, height);
  const Plane ab = blurred(product(a, b), width, height);
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (counts[i] == 0) continue;
    const float ma = mean_a[i], mb = mean_b[i];
    // With a = b both are rounded alike, so that the figure is 1.
    const float variance = (aa[i] - ma * ma) + (bb[i] - mb * mb), covariance = ab[i] - ma * mb;
    sum +=
        static_cast<double>((2 * ma * mb + c1) * (2 * covariance + c2) / ((ma * ma + mb * mb + c1) * (variance + c2)));
  }
  return sum;
}

}  // namespace lodestone::measure::detail
