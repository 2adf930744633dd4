// ColorRange: whether colours in a text file, which doesn't say, run to 1 or to 255.
#pragma once

#include <algorithm>
#include <cmath>

namespace lodestone::io {

/// Looks at all colour numbers of a file. Whole numbers with one above 1 are 0 to 255. Numbers with fractions are 0 to
/// 1, and some are a little or, in high dynamic range, a few times beyond; only where one is above 16, which is too
/// bright to be meant and as 0 to 255 still all but black, do they run to 255.
class ColorRange {
 public:
  void add(double value) {
    if (!std::isfinite(value)) return;
    whole_ = whole_ && value == std::floor(value);
    lowest_ = std::min(lowest_, value);
    largest_ = std::max(largest_, value);
  }
  /// Bytes written out: whole numbers from 0 to 255.
  bool is_bytes() const { return whole_ && lowest_ >= 0 && largest_ > 1 && largest_ <= 255; }
  /// What the numbers are to be divided by so that white is 1.
  float divisor() const { return is_bytes() || largest_ > kBrightest ? 255.0F : 1.0F; }

 private:
  static constexpr double kBrightest = 16;
  bool whole_ = true;
  double lowest_ = 0, largest_ = 0;
};

}  // namespace lodestone::io
