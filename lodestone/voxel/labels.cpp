#include "lodestone/voxel/labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "lodestone/base/units.h"
#include "lodestone/core/scanned_volume.h"

namespace lodestone::voxel {

namespace {

constexpr std::size_t kMostLabels = 4096;

// How values differ from those before them in their rows, where neither is 0.
struct Steps {
  std::uint64_t pairs = 0, steps = 0;
  double sum = 0;  // of the steps' sizes

  void add(double before, double value) {
    if (before == 0) return;
    ++pairs;
    if (value == before) return;
    ++steps;
    sum += std::abs(value - before);
  }
};

// Labels are alike in whole regions, and their numbers say nothing: grey values differ nearly everywhere, by a little
// (in scans 85 of 100 neighbours do, by 2 to 9 % of the range; random numbers by 33 %).
Result<void> check_labels(const std::map<std::int64_t, LabelBox>& boxes, const Steps& steps) {
  constexpr std::size_t kFewLabels = 32;
  if (boxes.size() <= kFewLabels || 2 * steps.steps <= steps.pairs) return {};
  const auto range = static_cast<double>(boxes.rbegin()->first - boxes.begin()->first);
  if (steps.sum > 0.2 * range * static_cast<double>(steps.steps)) return {};
  return fail(ErrorCode::bad_argument,
              fmt::format("holds {} different values, and {} of neighbours differ by a little: these are grey values, "
                          "not labels",
                          with_separators(boxes.size()),
                          percent(static_cast<double>(steps.steps) / static_cast<double>(steps.pairs))),
              {}, "leave `labels` out, and use `iso`");
}

}  // namespace

template <class T>
Result<std::map<std::int64_t, LabelBox>> label_boxes(const VolumeView<T>& volume, const Task& task) {
  std::map<std::int64_t, LabelBox> boxes;
  const auto& size = volume.grid.size;
  std::int64_t last = 0;
  LabelBox* box = nullptr;
  Steps steps;
  for (std::uint32_t z = 0; z < size[2]; ++z) {
    if (task.cancelled()) return cancelled_error("reading labels");
    for (std::uint32_t y = 0; y < size[1]; ++y) {
      double before = 0;
      for (std::uint32_t x = 0; x < size[0]; ++x) {
        const auto read = static_cast<double>(volume.at(x, y, z));
        const double value = std::isfinite(read) ? read : 0;
        if (value != 0) steps.add(before, value);
        before = value;
        if (value == 0) continue;
        if (value != std::floor(value) || std::abs(value) > 1e9) {
          return fail(ErrorCode::bad_argument, fmt::format("{} is no label: labels are whole numbers", value), {},
                      "leave `labels` out, and use `iso`");
        }
        const auto label = static_cast<std::int64_t>(value);
        if (box == nullptr || label != last) {
          box = &boxes[label];
          last = label;
          if (boxes.size() > kMostLabels) {
            return fail(ErrorCode::bad_argument, fmt::format("has more than {} labels", kMostLabels), {},
                        "leave `labels` out, and use `iso`");
          }
        }
        const std::uint32_t at[3] = {x, y, z};
        for (std::size_t k = 0; k < 3; ++k) {
          box->low[k] = std::min(box->low[k], at[k]);
          box->high[k] = std::max(box->high[k], at[k]);
        }
      }
    }
  }
  LODESTONE_TRY(check_labels(boxes, steps));
  return boxes;
}

// One label as a volume of its own: 255 where it is, one voxel more on every side that has one.
template <class T>
ScalarVolume<std::uint8_t> label_mask(const VolumeView<T>& volume, const LabelBox& box, std::int64_t label) {
  ScalarVolume<std::uint8_t> mask;
  const Vec3d spacing = volume.grid.spacing;
  mask.grid.spacing = spacing;
  for (std::size_t k = 0; k < 3; ++k) {
    mask.grid.size[k] = box.high[k] - box.low[k] + 1;
    mask.grid.origin[k] = volume.grid.origin[k] + box.low[k] * spacing[k];
  }
  mask.values.resize(static_cast<std::size_t>(mask.grid.count()));
  std::size_t i = 0;
  for (std::uint32_t z = box.low[2]; z <= box.high[2]; ++z) {
    for (std::uint32_t y = box.low[1]; y <= box.high[1]; ++y) {
      for (std::uint32_t x = box.low[0]; x <= box.high[0]; ++x, ++i) {
        mask.values[i] = static_cast<double>(volume.at(x, y, z)) == static_cast<double>(label) ? 255 : 0;
      }
    }
  }
  return mask;
}

// The value types of a ScannedVolume.
template Result<std::map<std::int64_t, LabelBox>> label_boxes(const VolumeView<std::uint8_t>&, const Task&);
template ScalarVolume<std::uint8_t> label_mask(const VolumeView<std::uint8_t>&, const LabelBox&, std::int64_t);
template Result<std::map<std::int64_t, LabelBox>> label_boxes(const VolumeView<std::int16_t>&, const Task&);
template ScalarVolume<std::uint8_t> label_mask(const VolumeView<std::int16_t>&, const LabelBox&, std::int64_t);
template Result<std::map<std::int64_t, LabelBox>> label_boxes(const VolumeView<std::uint16_t>&, const Task&);
template ScalarVolume<std::uint8_t> label_mask(const VolumeView<std::uint16_t>&, const LabelBox&, std::int64_t);
template Result<std::map<std::int64_t, LabelBox>> label_boxes(const VolumeView<float>&, const Task&);
template ScalarVolume<std::uint8_t> label_mask(const VolumeView<float>&, const LabelBox&, std::int64_t);

}  // namespace lodestone::voxel
