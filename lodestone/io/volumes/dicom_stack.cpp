#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include "lodestone/io/volumes/dicom_stack_detail.h"

namespace lodestone::io::detail {

namespace {

constexpr double kSameDirection = 1e-4;  // of unit vectors
constexpr double kEven = 0.01;           // steps that differ by less than this share are alike
constexpr double kGap = 1.9;             // from so many usual steps on, a slice is missing

bool near(Vec3d a, Vec3d b, double most) { return length(a - b) <= most; }

bool lie_alike(const DicomSlice& a, const DicomSlice& b) {
  return a.series == b.series && a.size == b.size && near(a.row, b.row, kSameDirection) &&
         near(a.column, b.column, kSameDirection) && std::abs(a.spacing[0] - b.spacing[0]) <= 1e-4 * a.spacing[0] &&
         std::abs(a.spacing[1] - b.spacing[1]) <= 1e-4 * a.spacing[1];
}

std::vector<std::vector<std::size_t>> groups_of(std::span<const DicomSlice> slices) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const auto fits = [&](const std::vector<std::size_t>& g) { return lie_alike(slices[g.front()], slices[i]); };
    const auto found = std::find_if(groups.begin(), groups.end(), fits);
    if (found == groups.end()) {
      groups.push_back({i});
    } else {
      found->push_back(i);
    }
  }
  return groups;
}

std::string listed(std::span<const DicomSlice> slices, const std::vector<std::vector<std::size_t>>& groups) {
  std::vector<std::string> lines;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const DicomSlice& first = slices[groups[g].front()];
    lines.push_back(fmt::format("{}: {} slices of {} x {}{}{}, {}", g + 1, groups[g].size(), first.size[0],
                                first.size[1], first.description.empty() ? "" : ", ", first.description, first.series));
  }
  return fmt::format("{}", fmt::join(lines, "; "));
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// Leaves one slice at each place, the first by name. `along` are places, rising, of `order`.
Result<void> drop_doubles(std::span<const DicomSlice> slices, double least, std::vector<std::size_t>& order,
                          std::vector<double>& along, std::vector<std::string>& warnings) {
  std::vector<std::size_t> kept;
  std::vector<double> places;
  std::vector<std::size_t> times;  // slices at each place
  std::vector<std::string> left_out;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (!kept.empty() && along[i] - places.back() <= least) {
      ++times.back();
      left_out.push_back(slices[order[i]].file);
      continue;
    }
    kept.push_back(order[i]);
    places.push_back(along[i]);
    times.push_back(1);
  }
  if (left_out.empty()) return {};
  const bool everywhere =
      times.front() > 1 && std::all_of(times.begin(), times.end(), [&](std::size_t n) { return n == times.front(); });
  if (everywhere) {
    return fail(ErrorCode::bad_format,
                fmt::format("the series has {} slices at every place (of several times or "
                            "echoes)",
                            times.front()),
                {}, "put those of one into a folder of their own");
  }
  const std::size_t named = std::min<std::size_t>(left_out.size(), 4);
  warnings.push_back(
      fmt::format("{} slices at the place of another are left out: {}{}", left_out.size(),
                  fmt::join(left_out.begin(), left_out.begin() + static_cast<std::ptrdiff_t>(named), ", "),
                  named < left_out.size() ? ", ..." : ""));
  order = std::move(kept);
  along = std::move(places);
  return {};
}

// A gap of several usual steps is a missing slice: nobody knows what was there.
Result<void> check_gaps(std::span<const DicomSlice> slices, const std::vector<std::size_t>& order,
                        const std::vector<double>& steps, double usual) {
  std::vector<std::string> gaps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i] < kGap * usual) continue;
    gaps.push_back(
        fmt::format("{:.4g} mm between {} and {}", steps[i], slices[order[i]].file, slices[order[i + 1]].file));
  }
  if (gaps.empty()) return {};
  const std::size_t named = std::min<std::size_t>(gaps.size(), 3);
  return fail(ErrorCode::bad_format,
              fmt::format("slices are missing: they are {:.4g} mm apart, but {}{}", usual,
                          fmt::join(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(named), ", "),
                          named < gaps.size() ? ", ..." : ""),
              {}, "add them, or leave the slices on one side of the gap out");
}

}  // namespace

Result<std::vector<std::size_t>> choose_series(std::span<const DicomSlice> slices, const std::string& chosen) {
  const std::vector<std::vector<std::size_t>> groups = groups_of(slices);
  if (chosen.empty()) {
    if (groups.size() == 1) return groups.front();
    return fail(ErrorCode::bad_argument, fmt::format("holds {} series: {}", groups.size(), listed(slices, groups)), {},
                "choose one, such as `series` 1");
  }
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(chosen.data(), chosen.data() + chosen.size(), number);
  if (error == std::errc() && end == chosen.data() + chosen.size() && number >= 1 && number <= groups.size()) {
    return groups[number - 1];
  }
  std::vector<std::size_t> named;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (slices[groups[g].front()].series == chosen) named.push_back(g);
  }
  if (named.size() == 1) return groups[named.front()];
  return fail(ErrorCode::bad_argument,
              fmt::format("there is {} series '{}'; there are {}", named.empty() ? "no" : "more than one", chosen,
                          listed(slices, groups)),
              {}, "choose one by its number, such as `series` 1");
}

Result<DicomStack> stack_slices(std::span<const DicomSlice> slices, std::span<const std::size_t> chosen) {
  DicomStack stack;
  stack.order.assign(chosen.begin(), chosen.end());
  const DicomSlice& any = slices[chosen.front()];
  const Vec3d normal = cross(any.row, any.column);
  const auto place = [&](std::size_t i) { return dot(slices[i].position, normal); };
  std::sort(stack.order.begin(), stack.order.end(), [&](std::size_t a, std::size_t b) {
    return place(a) != place(b) ? place(a) < place(b) : slices[a].file < slices[b].file;
  });
  std::vector<double> along;
  for (const std::size_t i : stack.order) along.push_back(place(i));
  const double least = 1e-3 * std::min(any.spacing[0], any.spacing[1]);
  if (const auto ok = drop_doubles(slices, least, stack.order, along, stack.warnings); !ok) return fail(ok.error());
  if (stack.order.size() < 2) {
    return fail(ErrorCode::unsupported, "one slice alone makes no volume", {}, "name the folder with all of them");
  }
  std::vector<double> steps;
  for (std::size_t i = 1; i < along.size(); ++i) steps.push_back(along[i] - along[i - 1]);
  const double usual = median(steps);
  if (const auto ok = check_gaps(slices, stack.order, steps, usual); !ok) return fail(ok.error());
  const Vec3d whole = slices[stack.order.back()].position - slices[stack.order.front()].position;
  stack.step = whole / static_cast<double>(steps.size());
  const auto [shortest, longest] = std::minmax_element(steps.begin(), steps.end());
  if (*longest - *shortest > kEven * usual) {
    for (const double a : along) stack.slice_positions.push_back(a - along.front());
    stack.warnings.push_back(
        fmt::format("slices are unevenly spaced ({:.4g} to {:.4g} mm): each stays where its "
                    "position says",
                    *shortest, *longest));
  }
  const double lean = length(cross(stack.step, normal)) / length(stack.step);
  if (lean > 1e-3) {
    stack.warnings.push_back(
        fmt::format("the gantry was tilted (slices shift by {:.4g} mm from one to the next): the "
                    "volume is sheared accordingly",
                    length(cross(stack.step, normal))));
  }
  return stack;
}

}  // namespace lodestone::io::detail
