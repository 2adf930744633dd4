// What writes validates what it is given, and leaves nothing behind.
#include <gtest/gtest.h>

#include <filesystem>

#include "lodestone/io/image_encode.h"
#include "lodestone/io/write.h"
#include "tests/support/broken.h"

namespace lodestone::io {
namespace {

namespace fs = std::filesystem;

class Entries : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override {
    EXPECT_TRUE(fs::is_empty(folder_));
    fs::remove_all(folder_);
  }
  const fs::path folder_ = fs::path(testing::TempDir()) / "lodestone_entries";
};

TEST_F(Entries, of_io_refuse_a_broken_model_in_any_format) {
  for (const auto& [name, model, line, mesh] : test::broken_models()) {
    for (const char* file : {"m.ply", "m.obj", "m.stl", "m.off", "m.glb", "m.gltf"}) {
      test::expect_refused(write_model(model, folder_ / file), line, name + " " + file);
    }
  }
}

TEST_F(Entries, of_io_refuse_a_ladder_whose_original_or_level_is_broken) {
  for (const auto& [name, model, line, mesh] : test::broken_models()) {
    Ladder ladder;
    ladder.levels.resize(2);
    ladder.original = test::whole_model();
    ladder.levels[1].model = model;
    test::expect_refused(write_ladder(ladder, folder_ / "m.glb"), "level 1, " + line, name);
    test::expect_refused(write_ladder(ladder, folder_ / "m{level}.ply"), "level 1, " + line, name);
    ladder.original = model;
    ladder.levels[1].model = test::whole_model();
    test::expect_refused(write_ladder(ladder, folder_ / "m.glb"), line, name);
    test::expect_refused(write_ladder(ladder, folder_ / "m{level}.obj"), line, name);
  }
  test::expect_bad_argument(write_ladder(Ladder{}, folder_ / "m.glb"), "no level");
}

TEST_F(Entries, of_io_refuse_a_picture_without_bytes) {
  test::expect_bad_argument(write_picture({4, 4, {}}, folder_ / "p.png"), "png");
  test::expect_bad_argument(write_picture({4, 4, {}}, folder_ / "p.webp"), "webp");
  test::expect_bad_argument(png_image({4, 4, {}}, "p"), "image");
}

}  // namespace
}  // namespace lodestone::io
