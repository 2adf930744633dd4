#include "lodestone/base/file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
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

TEST_F(File, what_may_never_end_is_refused_at_once) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder_ / "zero");
  for (const char* name : {"pipe", "zero"}) {
    const auto file = InputFile::open(folder_ / name);
    ASSERT_FALSE(file) << name;
    EXPECT_EQ(file.error().code, ErrorCode::cannot_read);
    EXPECT_NE(file.error().line().find(std::string(name) + ": is not a regular file; copy"), std::string::npos);
    EXPECT_FALSE(read_file(folder_ / name));
  }
  std::ofstream(folder_ / "real") << "text";
  fs::create_symlink("real", folder_ / "link");
  EXPECT_EQ(*read_file(folder_ / "link"), "text");
}

class Staging : public File {
 protected:
  void SetUp() override {
    File::SetUp();
    for (const char* name : {"a", "c"}) put(folder_ / name, std::string("old ") + name);
  }
  static void put(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }
  // "a" to "d" are written; of "a" and "c" there are older files.
  StagingFolder staged() const {
    auto staging = StagingFolder::create(folder_ / "out");
    EXPECT_TRUE(staging) << staging.error().line();
    for (const char* name : {"a", "b", "c", "d"}) put(staging->path() / name, std::string("new ") + name);
    return std::move(*staging);
  }
  void expect_old_files() const {
    EXPECT_EQ(*read_file(folder_ / "a"), "old a");
    EXPECT_EQ(*read_file(folder_ / "c"), "old c");
    EXPECT_FALSE(fs::exists(folder_ / "b"));
  }
};

TEST_F(Staging, commit_puts_all_in_place_and_leaves_nothing_else) {
  {
    StagingFolder staging = staged();
    expect_old_files();
    ASSERT_TRUE(staging.commit());
  }
  for (const char* name : {"a", "b", "c", "d"}) EXPECT_EQ(*read_file(folder_ / name), std::string("new ") + name);
  EXPECT_EQ(entries(), 4U);
}

TEST_F(Staging, without_commit_nothing_appears) {
  { const StagingFolder staging = staged(); }
  expect_old_files();
  EXPECT_EQ(entries(), 2U);
}

TEST_F(Staging, a_directory_in_the_way_of_one_changes_none) {
  fs::create_directory(folder_ / "d");
  {
    StagingFolder staging = staged();
    const auto done = staging.commit();
    ASSERT_FALSE(done);
    EXPECT_NE(done.error().line().find((folder_ / "d").string() + ": is a directory"), std::string::npos);
  }
  expect_old_files();
  EXPECT_EQ(entries(), 3U);
}

TEST_F(Staging, a_failure_on_the_way_puts_everything_back) {
  put(folder_ / "d", "old d");
  {
    StagingFolder staging = staged();
    fs::remove(staging.path() / "d");
    fs::create_directory(staging.path() / "d");  // can't be renamed over a file, which no check foresees
    const auto done = staging.commit();
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().where, (folder_ / "d").string());
  }
  expect_old_files();
  EXPECT_EQ(*read_file(folder_ / "d"), "old d");
  EXPECT_EQ(entries(), 3U);
}

TEST_F(Staging, what_a_killed_run_left_is_named) {
  auto first = StagingFolder::create(folder_ / "out");
  ASSERT_TRUE(first);
  const auto second = StagingFolder::create(folder_ / "out");
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().line().find("is in the way, left by a run that was killed; remove it"), std::string::npos);
}

}  // namespace
}  // namespace lodestone
