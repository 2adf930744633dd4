#include "lodestone/report/contact_sheet.h"

#include <gtest/gtest.h>

#include "lodestone/render/frame.h"
#include "support/shapes.h"

namespace lodestone::report {
namespace {

std::vector<SheetLevel> tori(std::initializer_list<std::pair<int, double>> levels) {
  std::vector<SheetLevel> out;
  for (const auto& [segments, error] : levels) {
    out.push_back({*render::Scene::create(make_model(test::torus(segments))), error});
  }
  return out;
}

SheetOptions small() {
  SheetOptions options;
  options.picture.width = 120;
  options.picture.height = 90;
  return options;
}

// Pixels of a cell that differ from the background.
std::size_t drawn(const Pixels& sheet, std::uint32_t left, std::uint32_t top, const SheetOptions& options) {
  std::size_t count = 0;
  for (std::uint32_t y = 0; y < options.picture.height; ++y) {
    for (std::uint32_t x = 0; x < options.picture.width; ++x) {
      count += sheet.at(left + x, top + y) != options.picture.background ? 1U : 0U;
    }
  }
  return count;
}

TEST(ContactSheet, upper_cells_are_pictures_from_one_camera) {
  const auto levels = tori({{40, 0}, {12, 0.1}});
  const SheetOptions options = small();
  const auto sheet = contact_sheet(levels, options);
  ASSERT_TRUE(sheet);
  const SheetSize size = sheet_size(2, options);
  EXPECT_EQ(sheet->width, size.width);
  EXPECT_EQ(sheet->height, size.height);
  const Camera camera = levels[0].scene.framed(options.angles, 120.0 / 90, options.lens, options.up);
  for (std::uint32_t i = 0; i < 2; ++i) {
    const auto picture = render::render(levels[i].scene, camera, options.picture);
    for (std::uint32_t y = 0; y < 90; ++y) {
      for (std::uint32_t x = 0; x < 120; ++x) {
        ASSERT_EQ(sheet->at(12 + i * 132 + x, 12 + y), picture->at(x, y)) << i << ' ' << x << ' ' << y;
      }
    }
  }
}

// A level that errs twice as much takes over from twice as far, where it is seen about half as large.
TEST(ContactSheet, lower_cells_shrink_with_the_error) {
  const SheetOptions options = small();
  const auto near = contact_sheet(tori({{40, 0}, {12, 0.05}}), options);
  const auto far = contact_sheet(tori({{40, 0}, {12, 0.1}}), options);
  ASSERT_TRUE(near && far);
  const std::uint32_t top = sheet_size(2, options).height - 90 - 2 * 22 - 6;
  const auto large = drawn(*near, 12 + 132, top, options), small_one = drawn(*far, 12 + 132, top, options);
  EXPECT_GT(small_one, 20U);
  EXPECT_NEAR(static_cast<double>(large) / static_cast<double>(small_one), 4, 0.8);
}

// A level with a small error takes over from nearby, where the model is larger than the cell.
TEST(ContactSheet, lower_cells_show_the_whole_model) {
  SheetOptions options = small();
  for (const bool flat : {false, true}) {
    options.lens.orthographic = flat;
    for (const double error : {1e-5, 1e-3, 0.01}) {
      const auto sheet = contact_sheet(tori({{40, 0}, {12, error}}), options);
      ASSERT_TRUE(sheet);
      const std::uint32_t top = sheet_size(2, options).height - 90 - 2 * 22 - 6;
      std::size_t at_sides = 0;
      for (std::uint32_t x = 0; x < 120; ++x) {
        for (const std::uint32_t y : {0U, 89U}) at_sides += sheet->at(144 + x, top + y) != options.picture.background;
      }
      for (std::uint32_t y = 0; y < 90; ++y) {
        for (const std::uint32_t x : {0U, 119U}) at_sides += sheet->at(144 + x, top + y) != options.picture.background;
      }
      EXPECT_EQ(at_sides, 0U) << error;
      EXPECT_GT(drawn(*sheet, 144, top, options), 500U) << error;
    }
  }
}

TEST(ContactSheet, levels_without_error_and_single_ones) {
  EXPECT_TRUE(contact_sheet(tori({{12, 0}}), small()));
  EXPECT_TRUE(contact_sheet(tori({{12, 0}, {12, 0}}), small()));
  SheetOptions flat = small();
  flat.lens.orthographic = true;
  EXPECT_TRUE(contact_sheet(tori({{12, 0}, {9, 0.2}}), flat));
}

TEST(ContactSheet, what_it_refuses) {
  EXPECT_EQ(contact_sheet({}, small()).error().code, ErrorCode::bad_argument);
  SheetOptions heat = small(), large = small();
  heat.picture.shading = render::Shading::heat;
  EXPECT_EQ(contact_sheet(tori({{12, 0}}), heat).error().code, ErrorCode::bad_argument);
  large.picture.width = render::kMostSide;
  EXPECT_EQ(contact_sheet(tori({{12, 0}}), large).error().code, ErrorCode::bad_argument);
}

TEST(ContactSheet, same_bytes_for_any_thread_count) {
  const auto levels = tori({{40, 0}, {12, 0.1}});
  const auto one = contact_sheet(levels, small(), Task::root({}, 1));
  const auto seven = contact_sheet(levels, small(), Task::root({}, 7));
  EXPECT_EQ(one->rgba, seven->rgba);
}

}  // namespace
}  // namespace lodestone::report
