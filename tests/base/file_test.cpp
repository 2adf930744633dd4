#include "lodestone/base/file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace lodestone {
namespace {

namespace fs = std::filesystem;

class File : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("lodestone_file_test_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  fs::path folder_;
};

TEST_F(File, commit_puts_the_bytes_under_the_name) {
  auto out = OutputFile::create(folder_ / "a.bin");
  ASSERT_TRUE(out) << out.error().line();
  const std::string text(3'000'000, 'x');
  out->write(text);
  out->write("end");
  EXPECT_FALSE(fs::exists(folder_ / "a.bin"));
  ASSERT_TRUE(out->commit());
  EXPECT_EQ(*read_file(folder_ / "a.bin"), text + "end");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(File, without_commit_nothing_appears_and_the_old_file_stays) {
  std::ofstream(folder_ / "a.bin") << "old";
  {
    auto out = OutputFile::create(folder_ / "a.bin");
    ASSERT_TRUE(out);
    out->write("new");
  }
  EXPECT_EQ(*read_file(folder_ / "a.bin"), "old");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(File, commit_replaces_an_existing_file) {
  std::ofstream(folder_ / "a.bin") << "old and longer";
  auto out = OutputFile::create(folder_ / "a.bin");
  out->write("new");
  ASSERT_TRUE(out->commit());
  EXPECT_EQ(*read_file(folder_ / "a.bin"), "new");
}

TEST_F(File, errors_name_the_file) {
  const auto missing = InputFile::open(folder_ / "none");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::cannot_read);
  EXPECT_NE(missing.error().line().find("none: no such file"), std::string::npos);
  EXPECT_FALSE(InputFile::open(folder_));
  const auto nowhere = OutputFile::create(folder_ / "no" / "a.bin");
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().code, ErrorCode::cannot_write);
  EXPECT_FALSE(OutputFile::create(folder_));
}

}  // namespace
}  // namespace lodestone
