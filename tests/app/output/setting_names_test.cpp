#include "app/output/setting_names.h"

#include <gtest/gtest.h>

namespace lodestone::app {
namespace {

TEST(SettingNames, become_options) {
  EXPECT_EQ(with_options("raise `resolution`, or use `keep_thin`"), "raise --resolution, or use --keep-thin");
  EXPECT_EQ(with_options("(`weld_tolerance`, or unwrap the model)"), "(--weld, or unwrap the model)");
  EXPECT_EQ(with_options("`build_voxel_ladder()` `then_collapse`"), "--method voxel --then-collapse");
}

TEST(SettingNames, leave_other_text_alone) {
  for (const char* text : {"", "plain", "a ` b", "`unheard_of` and `resolution", "``"})
    EXPECT_EQ(with_options(text), text);
  EXPECT_EQ(with_options("`a `iso`"), "`a --iso");
}

TEST(SettingNames, an_error_keeps_its_place) {
  const Error error = with_options(Error{ErrorCode::empty, "no `iso`", "`iso`", "give `iso`"});
  EXPECT_EQ(error.line(), "`iso`: no --iso; give --iso");
}

}  // namespace
}  // namespace lodestone::app
