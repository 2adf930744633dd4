#include "app/options/suggest.h"

#include <gtest/gtest.h>

namespace lodestone::app {
namespace {

const std::vector<std::string> kVerbs{"build",    "simplify", "measure", "render",
                                      "voxelize", "info",     "convert", "sample"};
const std::vector<std::string> kOptions{"--levels", "--triangles", "--ratio", "--fov", "--output"};

TEST(Suggest, a_slip_of_the_keyboard_finds_its_word) {
  EXPECT_EQ(nearest("biuld", kVerbs), "build");
  EXPECT_EQ(nearest("buidl", kVerbs), "build");
  EXPECT_EQ(nearest("simplfy", kVerbs), "simplify");
  EXPECT_EQ(nearest("messure", kVerbs), "measure");
  EXPECT_EQ(nearest("--trianglse", kOptions), "--triangles");
  EXPECT_EQ(nearest("-levels", kOptions), "--levels");
}

TEST(Suggest, the_beginning_of_a_word_is_enough) {
  EXPECT_EQ(nearest("simp", kVerbs), "simplify");
  EXPECT_EQ(nearest("--tri", kOptions), "--triangles");
  EXPECT_EQ(nearest("in", kVerbs), "");
}

TEST(Suggest, what_is_far_from_everything_finds_nothing) {
  for (const char* word : {"view", "xyzzy", "teapot", "q", "", "--", "-x", "--compression-level"}) {
    EXPECT_EQ(nearest(word, kVerbs), "") << word;
    EXPECT_EQ(nearest(word, kOptions), "") << word;
  }
  EXPECT_EQ(did_you_mean("teapot", kVerbs), "");
}

TEST(Suggest, names_that_others_use_are_known) {
  for (const char* word : {"decimate", "reduce", "optimize"}) EXPECT_EQ(meant(word, kVerbs), "simplify") << word;
  for (const char* word : {"lod", "levels"}) EXPECT_EQ(meant(word, kVerbs), "build") << word;
  EXPECT_EQ(meant("view", kVerbs), "render");
  EXPECT_EQ(meant("--faces", kOptions), "--triangles");
  EXPECT_EQ(did_you_mean("decimate", kVerbs), ", did you mean simplify?");
}

TEST(Suggest, only_what_there_is_is_named) {
  EXPECT_EQ(meant("view", {"build", "measure"}), "");
  EXPECT_EQ(meant("decimate", kOptions), "");
}

}  // namespace
}  // namespace lodestone::app
