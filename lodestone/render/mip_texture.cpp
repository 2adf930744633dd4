#include <algorithm>
#include <cmath>

#include "lodestone/render/mip_texture_detail.h"
#include "lodestone/render/tone_detail.h"

namespace lodestone::render::detail {

namespace {

// The mean of 2 x 2 pixels as light; an odd last row or column is left to its neighbour.
Pixels halved(const Pixels& from) {
  const Tone& tone = Tone::get();
  Pixels to;
  to.width = std::max(1U, from.width / 2);
  to.height = std::max(1U, from.height / 2);
  to.rgba.resize(std::size_t{to.width} * to.height * 4);
  for (std::uint32_t y = 0; y < to.height; ++y) {
    const std::uint32_t y0 = std::min(2 * y, from.height - 1), y1 = std::min(2 * y + 1, from.height - 1);
    for (std::uint32_t x = 0; x < to.width; ++x) {
      const std::uint32_t x0 = std::min(2 * x, from.width - 1), x1 = std::min(2 * x + 1, from.width - 1);
      const auto a = from.at(x0, y0), b = from.at(x1, y0), c = from.at(x0, y1), d = from.at(x1, y1);
      std::uint8_t* out = to.rgba.data() + (std::size_t{y} * to.width + x) * 4;
      for (std::size_t k = 0; k < 3; ++k) {
        out[k] = tone.byte((tone.light(a[k]) + tone.light(b[k]) + tone.light(c[k]) + tone.light(d[k])) * 0.25F);
      }
      out[3] = static_cast<std::uint8_t>((a[3] + b[3] + c[3] + d[3] + 2) / 4);
    }
  }
  return to;
}

// The two pixels around a coordinate, wrapped, and the second's weight.
struct Neighbours {
  std::uint32_t first, second;
  float weight;
};

Neighbours neighbours(float coordinate, std::uint32_t size) {
  if (!(std::abs(coordinate) < 1e6F)) coordinate = 0;
  const auto whole = static_cast<float>(static_cast<std::int32_t>(coordinate));
  float part = coordinate - whole;
  if (part < 0) part += 1;
  const float at = part * static_cast<float>(size) + static_cast<float>(size) - 0.5F;  // above 0
  const auto cell = static_cast<std::uint32_t>(at);
  return {cell % size, (cell + 1) % size, at - static_cast<float>(cell)};
}

Vec3f mix(Vec3f a, Vec3f b, float t) { return a + (b - a) * t; }

}  // namespace

MipTexture::MipTexture(std::shared_ptr<const Pixels> pixels) : full_(std::move(pixels)) {
  for (const Pixels* last = full_.get(); last->width > 1 || last->height > 1; last = &smaller_.back()) {
    smaller_.push_back(halved(*last));
  }
}

Texel MipTexture::bilinear(const Pixels& level, Vec2f uv) const {
  const Tone& tone = Tone::get();
  const Neighbours x = neighbours(uv.x, level.width), y = neighbours(uv.y, level.height);
  const auto a = level.at(x.first, y.first), b = level.at(x.second, y.first);
  const auto c = level.at(x.first, y.second), d = level.at(x.second, y.second);
  const auto light = [&](const auto& p) { return tone.light(p[0], p[1], p[2]); };
  const auto alpha = [](const auto& p) { return static_cast<float>(p[3]) * (1.0F / 255); };
  Texel out;
  out.light = mix(mix(light(a), light(b), x.weight), mix(light(c), light(d), x.weight), y.weight);
  const float top = alpha(a) + (alpha(b) - alpha(a)) * x.weight, low = alpha(c) + (alpha(d) - alpha(c)) * x.weight;
  out.alpha = top + (low - top) * y.weight;
  return out;
}

Texel MipTexture::sample(Vec2f uv, Vec2f per_x, Vec2f per_y) const {
  const auto w = static_cast<float>(full_->width), h = static_cast<float>(full_->height);
  const auto squared = [&](Vec2f d) { return d.x * w * d.x * w + d.y * h * d.y * h; };
  // Pixels of the texture that one of the picture covers along its longer and shorter side; their geometric mean keeps
  // slanted surfaces sharper than the longer alone would.
  const float texels = std::sqrt(std::sqrt(squared(per_x) * squared(per_y)));
  if (!(texels > 1) || smaller_.empty()) return bilinear(*full_, uv);
  const auto level_at = [&](std::size_t i) -> const Pixels& {
    return i == 0 ? *full_ : smaller_[std::min(i, smaller_.size()) - 1];
  };
  std::size_t level = 0;
  float scale = 1;
  while (level < smaller_.size() && texels >= scale * 2) {
    scale *= 2;
    ++level;
  }
  const Texel fine = bilinear(level_at(level), uv), coarse = bilinear(level_at(level + 1), uv);
  const float t = std::min(texels / scale - 1, 1.0F);
  return {mix(fine.light, coarse.light, t), fine.alpha + (coarse.alpha - fine.alpha) * t};
}

}  // namespace lodestone::render::detail
