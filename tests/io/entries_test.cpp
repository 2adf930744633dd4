// What writes validates what it is given, and leaves nothing behind.
#include <gtest/gtest.h>

#include <filesystem>

#include "lodestone/io/images/encode.h"
#include "lodestone/io/write.h"
#include "support/broken.h"
#include "support/folder.h"

namespace lodestone::io {
namespace {

class Entries : public test::InFolder {
 protected:
  void TearDown() override { EXPECT_TRUE(std::filesystem::is_empty(folder_)); }
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
