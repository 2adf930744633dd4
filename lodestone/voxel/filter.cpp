// Filters against the noise of scanned volumes: Gaussian blur and median.
//
// 1. exp_minus(), kernel_of(): weights of the Gaussian, cut off after three standard deviations, with the sum 1. The
//    exponential is a series, as libm's differs from machine to machine.
// 2. blur_rows(): the blur along one axis of a slice. A Gaussian is the product of three along the axes, so gaussian()
//    runs it once an axis. Along y and z whole rows are added, so that the inner loop runs along memory.
// 3. median_of(): the middle one of the (2 radius + 1)³ values around each voxel; what is no number
//    counts as the least.
// 4. gaussian_reach(), padded(), as_float(): how far a blur looks, a margin of zeros for it, and values as floats.
// Invariants: beyond the border the border's values go on. A slice belongs to one thread and each sum has a fixed
// order: the same values for any thread count. Cost: blur O(voxels · sigma), median O(voxels · radius³).
#include "lodestone/voxel/filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/core/validate.h"

namespace lodestone::voxel {

namespace {

// e^-x for x >= 0 without libm, so that all machines agree: (e^(-x / 1024))^1024 by its series.
double exp_minus(double x) {
  if (x > 700) return 0;  // it is, in floats, and the series no longer converges
  const double y = -x / 1024;
  double term = 1, sum = 1;
  for (int k = 1; k < 12; ++k) {
    term *= y / k;
    sum += term;
  }
  for (int k = 0; k < 10; ++k) sum *= sum;
  return sum;
}

std::vector<float> kernel_of(double sigma) {
  const auto reach = static_cast<std::size_t>(std::ceil(3 * sigma));
  std::vector<double> half(reach + 1);
  double sum = 0;
  for (std::size_t k = 0; k <= reach; ++k) {
    const double d = static_cast<double>(k) / sigma;
    half[k] = exp_minus(0.5 * d * d);
    sum += k == 0 ? half[k] : 2 * half[k];
  }
  std::vector<float> kernel(2 * reach + 1);
  for (std::size_t k = 0; k <= reach; ++k) {
    kernel[reach + k] = kernel[reach - k] = static_cast<float>(half[k] / sum);
  }
  return kernel;
}

// Place at + offset - reach of a row of `count`, or the nearest that there is.
std::size_t kept_inside(std::size_t at, std::size_t offset, std::size_t reach, std::size_t count) {
  const std::size_t moved = at + offset;
  return moved < reach ? 0 : std::min(moved - reach, count - 1);
}

// Along one axis: `lines` of rows of x values that follow each other `stride` rows apart. Whole rows are added, so that
// the inner loop runs along x whatever the axis; along x itself each value is summed.
void blur_rows(const ScalarVolume<float>& from, std::size_t axis, const std::vector<float>& kernel, std::uint32_t z,
               ScalarVolume<float>& to) {
  const auto& size = from.grid.size;
  const std::size_t reach = kernel.size() / 2;
  for (std::uint32_t y = 0; y < size[1]; ++y) {
    float* out = to.values.data() + to.index(0, y, z);
    if (axis == 0) {
      const float* row = from.values.data() + from.index(0, y, z);
      for (std::size_t x = 0; x < size[0]; ++x) {
        float sum = 0;
        for (std::size_t k = 0; k < kernel.size(); ++k) sum += kernel[k] * row[kept_inside(x, k, reach, size[0])];
        out[x] = sum;
      }
      continue;
    }
    std::fill(out, out + size[0], 0.0F);
    for (std::size_t k = 0; k < kernel.size(); ++k) {
      const std::size_t at = kept_inside(axis == 1 ? y : z, k, reach, size[axis]);
      const auto other = static_cast<std::uint32_t>(at);
      const float* row = from.values.data() + (axis == 1 ? from.index(0, other, z) : from.index(0, y, other));
      for (std::size_t x = 0; x < size[0]; ++x) out[x] += kernel[k] * row[x];
    }
  }
}

template <class T>
Result<ScalarVolume<float>> floats_of(const VolumeView<T>& volume, const Task& task) {
  LODESTONE_TRY(validate(volume));
  ScalarVolume<float> out;
  out.grid = volume.grid;
  out.values.resize(volume.values.size());
  parallel_for(volume.values.size(), std::size_t{1} << 18, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) out.values[i] = static_cast<float>(volume.values[i]);
  });
  if (task.cancelled()) return cancelled_error("filtering");
  return out;
}

template <class T>
Result<ScalarVolume<float>> median_of(const VolumeView<T>& volume, std::uint32_t radius, const Task& task) {
  LODESTONE_TRY(validate(volume));
  if (radius < 1 || radius > 7) {
    return fail(ErrorCode::bad_argument, fmt::format("a median can't look {} voxels far", radius), {}, "use 1 to 7");
  }
  ScalarVolume<float> out;
  out.grid = volume.grid;
  out.values.resize(volume.values.size());
  const auto& size = volume.grid.size;
  const std::size_t side = 2 * radius + 1;
  parallel_for(size[2], 1, task, [&](std::size_t slice, std::size_t, std::size_t) {
    std::vector<T> around(side * side * side);
    for (std::uint32_t y = 0; y < size[1]; ++y) {
      for (std::uint32_t x = 0; x < size[0]; ++x) {
        std::size_t n = 0;
        for (std::size_t dz = 0; dz < side; ++dz) {
          const auto z = static_cast<std::uint32_t>(kept_inside(slice, dz, radius, size[2]));
          for (std::size_t dy = 0; dy < side; ++dy) {
            const auto row = static_cast<std::uint32_t>(kept_inside(y, dy, radius, size[1]));
            for (std::size_t dx = 0; dx < side; ++dx) {
              const T value = volume.at(static_cast<std::uint32_t>(kept_inside(x, dx, radius, size[0])), row, z);
              around[n++] = value == value ? value : std::numeric_limits<T>::lowest();  // not a number: the least
            }
          }
        }
        const auto middle = around.begin() + static_cast<std::ptrdiff_t>(n / 2);
        std::nth_element(around.begin(), middle, around.end(), [](T a, T b) { return a < b; });
        out.values[out.index(x, y, static_cast<std::uint32_t>(slice))] = static_cast<float>(*middle);
      }
    }
  });
  if (task.cancelled()) return cancelled_error("filtering");
  return out;
}

}  // namespace

std::array<std::uint32_t, 3> gaussian_reach(Vec3d sigma) {
  std::array<std::uint32_t, 3> reach{};
  for (std::size_t k = 0; k < 3; ++k) reach[k] = static_cast<std::uint32_t>(std::ceil(3 * sigma[k]));
  return reach;
}

ScalarVolume<float> padded(const VolumeView<std::uint8_t>& volume, const std::array<std::uint32_t, 3>& more) {
  ScalarVolume<float> out;
  out.grid = volume.grid;
  for (std::size_t k = 0; k < 3; ++k) {
    out.grid.size[k] += 2 * more[k];
    out.grid.origin[k] -= more[k] * volume.grid.spacing[k];
  }
  out.values.resize(static_cast<std::size_t>(out.grid.count()), 0.0F);
  const auto& size = volume.grid.size;
  for (std::uint32_t z = 0; z < size[2]; ++z) {
    for (std::uint32_t y = 0; y < size[1]; ++y) {
      float* to = out.values.data() + out.index(more[0], y + more[1], z + more[2]);
      for (std::uint32_t x = 0; x < size[0]; ++x) to[x] = static_cast<float>(volume.at(x, y, z));
    }
  }
  return out;
}

Result<ScalarVolume<float>> as_float(const VolumeView<std::uint8_t>& volume, Task task) {
  return floats_of(volume, task);
}
Result<ScalarVolume<float>> as_float(const VolumeView<std::int16_t>& volume, Task task) {
  return floats_of(volume, task);
}
Result<ScalarVolume<float>> as_float(const VolumeView<std::uint16_t>& volume, Task task) {
  return floats_of(volume, task);
}
Result<ScalarVolume<float>> as_float(const VolumeView<float>& volume, Task task) { return floats_of(volume, task); }

Result<ScalarVolume<float>> gaussian(ScalarVolume<float> volume, Vec3d sigma, Task task) {
  LODESTONE_TRY(validate(volume.view()));
  for (std::size_t k = 0; k < 3; ++k) {
    if (sigma[k] >= 0 && sigma[k] <= 1000) continue;
    return fail(ErrorCode::bad_argument, fmt::format("a blur of {} voxels can't be", sigma[k]), {}, "use 0 to 1000");
  }
  ScalarVolume<float> other{volume.grid, std::vector<float>(volume.values.size())};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(sigma[axis] > 0)) continue;
    const std::vector<float> kernel = kernel_of(sigma[axis]);
    parallel_for(volume.grid.size[2], 1, task, [&](std::size_t z, std::size_t, std::size_t) {
      blur_rows(volume, axis, kernel, static_cast<std::uint32_t>(z), other);
    });
    if (task.cancelled()) return cancelled_error("filtering");
    std::swap(volume.values, other.values);
  }
  return volume;
}

Result<ScalarVolume<float>> median(const VolumeView<std::uint8_t>& volume, std::uint32_t radius, Task task) {
  return median_of(volume, radius, task);
}
Result<ScalarVolume<float>> median(const VolumeView<std::int16_t>& volume, std::uint32_t radius, Task task) {
  return median_of(volume, radius, task);
}
Result<ScalarVolume<float>> median(const VolumeView<std::uint16_t>& volume, std::uint32_t radius, Task task) {
  return median_of(volume, radius, task);
}
Result<ScalarVolume<float>> median(const VolumeView<float>& volume, std::uint32_t radius, Task task) {
  return median_of(volume, radius, task);
}

}  // namespace lodestone::voxel
