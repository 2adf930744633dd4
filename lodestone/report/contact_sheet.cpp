// All levels of a ladder in one picture: a column a level.
//
// Problem: levels differ when all are seen at one size, and should not when each is seen from where it takes over.
// A sheet shows both.
// 1. upper_row(), lower_row(), left_of(), sheet_size(): where cells and captions lie.
// 2. check(): that the sheet is not larger than a picture may be.
// 3. at_distance(): the camera of the lower row: from where a level takes over, as large as the screen shows it then,
//    reduced where that would not fit into the cell.
// 4. paste(), write_line(): a picture and its captions.
// 5. contact_sheet(): above all levels from one camera, which frames the original; below each from its own distance.
// Invariants: the upper row's camera depends on the original alone; captions are cut to their cell. The renderer gives
// the same bytes for any thread count, so the sheet has the same, too. Cost: two pictures a level.
#include "lodestone/report/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "lodestone/base/units.h"
#include "lodestone/render/frame.h"
#include "lodestone/render/text.h"

namespace lodestone::report {

namespace {

constexpr std::uint32_t kGap = 12;      // between cells and around them, pixels
constexpr std::int32_t kTextScale = 2;  // pixels of a dot
constexpr std::uint32_t kLine = (render::kGlyphHeight + 4) * kTextScale;
constexpr std::array<std::uint8_t, 3> kInk{30, 32, 36};
constexpr std::array<std::uint8_t, 4> kPaper{255, 255, 255, 255};

struct Row {
  std::uint32_t top;      // of its pictures
  std::uint32_t caption;  // top of the text below them
};

Row upper_row(const SheetOptions& options) { return {kGap, kGap + options.picture.height + kGap / 2}; }

Row lower_row(const SheetOptions& options) {
  const std::uint32_t top = upper_row(options).caption + 2 * kLine + kGap;
  return {top, top + options.picture.height + kGap / 2};
}

std::uint32_t left_of(std::size_t column, const SheetOptions& options) {
  return kGap + static_cast<std::uint32_t>(column) * (options.picture.width + kGap);
}

}  // namespace

SheetSize sheet_size(std::size_t levels, const SheetOptions& options) {
  return {left_of(levels, options), lower_row(options).caption + 2 * kLine};
}

namespace {

Result<void> check(const std::vector<SheetLevel>& levels, const SheetOptions& options) {
  if (levels.empty()) return fail(ErrorCode::bad_argument, "a sheet needs at least one level");
  if (options.picture.shading == render::Shading::heat) {
    return fail(ErrorCode::bad_argument, "a sheet shows no heat", {}, "choose another shading");
  }
  const auto fits = [](std::uint64_t side) { return side <= render::kMostSide; };
  const SheetSize size = sheet_size(levels.size(), options);
  if (fits(options.picture.width) && fits(options.picture.height) && levels.size() <= render::kMostSide &&
      fits(size.width) && fits(size.height)) {
    return {};
  }
  return fail(ErrorCode::bad_argument,
              fmt::format("{} levels of {} x {} pixels make a sheet of {} x {}, {} is the most", levels.size(),
                          options.picture.width, options.picture.height, size.width, size.height, render::kMostSide),
              {}, "make the pictures smaller");
}

std::string length_text(double length, const std::string& unit) {
  return fmt::format("{:.4g}{}{}", length, unit.empty() ? "" : " ", unit);
}

// A camera, and the scale of its picture against the screen: 1, or less where the model would not fit into the cell.
struct LowerView {
  Camera camera;
  double scale = 1;
};

// As the screen shows the model from `distance`, which is to the surface of the sphere around the original's box. Where
// that sphere is larger than the cell, the picture is reduced and taken from no nearer than the sphere's radius, as
// little would be seen from nearer.
LowerView at_distance(const Camera& framed, const render::Scene& original, double error, double distance,
                      const SheetOptions& options) {
  LowerView out{framed, 1};
  const double radius = original.bounds().diagonal() / 2;
  const auto lines = static_cast<double>(options.picture.height);
  const double on_screen =
      framed.orthographic ? lines / 2 * error / options.pixels : framed.half_height * lines / options.view.height_px;
  const double narrow = std::min(1.0, static_cast<double>(options.picture.width) / lines);
  // Half the height that holds the sphere, from so far away.
  const auto whole = [&](double away) {
    return (framed.orthographic ? radius : radius / std::sqrt(away * away - radius * radius)) / narrow;
  };
  double away = radius + distance;
  out.camera.half_height = on_screen;
  if (whole(away) > on_screen) {
    const double nearest = std::max(away, 2 * radius);
    out.camera.half_height = whole(nearest);
    out.scale = on_screen / out.camera.half_height * (framed.orthographic ? 1 : away / nearest);
    away = nearest;
  }
  out.camera.eye = original.bounds().center() - framed.forward * away;
  out.camera.near_distance = (away - radius) / 2;
  return out;
}

std::string size_text(double scale, const SheetOptions& options) {
  if (scale == 1) return fmt::format("as large as on {:g} lines", options.view.height_px);
  return fmt::format("at {:.2g} % of its size on {:g} lines", 100 * scale, options.view.height_px);
}

void paste(const Pixels& picture, Pixels& sheet, std::uint32_t left, std::uint32_t top) {
  for (std::uint32_t y = 0; y < picture.height; ++y) {
    std::memcpy(sheet.rgba.data() + (std::size_t{top + y} * sheet.width + left) * 4,
                picture.rgba.data() + std::size_t{y} * picture.width * 4, std::size_t{picture.width} * 4);
  }
}

// Cut to the cell, so that no caption runs into the next.
void write_line(Pixels& sheet, std::string text, std::uint32_t left, std::uint32_t top, const SheetOptions& options) {
  const std::size_t fits = options.picture.width / static_cast<std::uint32_t>(render::kGlyphAdvance * kTextScale);
  if (text.size() > fits) text.resize(fits);
  render::draw_text(sheet, text, {static_cast<std::int32_t>(left), static_cast<std::int32_t>(top), kTextScale}, kInk);
}

}  // namespace

Result<Pixels> contact_sheet(const std::vector<SheetLevel>& levels, const SheetOptions& options, Task task) {
  LODESTONE_TRY(check(levels, options));
  const render::Scene& original = levels.front().scene;
  const double aspect = static_cast<double>(options.picture.width) / options.picture.height;
  const Camera framed = original.framed(options.angles, aspect, options.lens, options.up);
  const double diagonal = original.bounds().diagonal();
  const SheetSize size = sheet_size(levels.size(), options);
  Pixels sheet{size.width, size.height, std::vector<std::uint8_t>(std::size_t{size.width} * size.height * 4)};
  for (std::size_t i = 0; i < sheet.rgba.size(); ++i) sheet.rgba[i] = kPaper[i % 4];

  for (std::size_t i = 0; i < levels.size(); ++i) {
    const Task part = task.part(1.0 / static_cast<double>(levels.size()));
    const std::uint32_t left = left_of(i, options);
    const Result<Pixels> upper = render::render(levels[i].scene, framed, options.picture, part.part(0.5));
    LODESTONE_TRY(upper);
    paste(*upper, sheet, left, upper_row(options).top);
    const std::uint32_t caption = upper_row(options).caption;
    write_line(sheet, fmt::format("{}: {} triangles", i, with_separators(levels[i].scene.triangle_count())), left,
               caption, options);
    const double share = diagonal > 0 ? levels[i].error / diagonal * 100 : 0;
    write_line(
        sheet,
        i == 0 ? "original" : fmt::format("error {} ({:.3g} %)", length_text(levels[i].error, options.unit), share),
        left, caption + kLine, options);

    const double error = levels[std::min(std::max<std::size_t>(i, 1), levels.size() - 1)].error;
    const double distance = measure::switch_distance(error, options.pixels, options.view);
    if (!(distance > 1e-9 * diagonal)) continue;  // as exact as the original: it never has to be far away
    const LowerView view = at_distance(framed, original, error, distance, options);
    const Result<Pixels> lower = render::render(levels[i].scene, view.camera, options.picture, part.part(0.5));
    LODESTONE_TRY(lower);
    paste(*lower, sheet, left, lower_row(options).top);
    const std::uint32_t below = lower_row(options).caption;
    write_line(sheet, fmt::format("{} {} away", i == 0 ? "until" : "from", length_text(distance, options.unit)), left,
               below, options);
    write_line(sheet, size_text(view.scale, options), left, below + kLine, options);
  }
  return sheet;
}

}  // namespace lodestone::report
