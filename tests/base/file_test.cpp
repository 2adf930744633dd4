#include "lodestone/base/file.h"
#include "support/folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

namespace lodestone {
namespace {

namespace fs = std::filesystem;

class File : public test::InFolder {
 protected:
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
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

TEST_F(File, a_write_protected_file_is_refused) {
  std::ofstream(folder_ / "a.bin") << "old";
  fs::permissions(folder_ / "a.bin", fs::perms::owner_read);
  fs::create_symlink("a.bin", folder_ / "link");
  for (const char* name : {"a.bin", "link"}) {
    const auto out = OutputFile::create(folder_ / name);
    ASSERT_FALSE(out) << name;
    EXPECT_EQ(out.error().code, ErrorCode::cannot_write);
    EXPECT_NE(out.error().line().find("is write-protected"), std::string::npos) << out.error().line();
  }
  EXPECT_EQ(*read_file(folder_ / "a.bin"), "old");
  EXPECT_EQ(entries(), 2U);
}

TEST_F(File, a_replaced_file_keeps_its_permissions) {
  const fs::perms only_mine = fs::perms::owner_read | fs::perms::owner_write;
  std::ofstream(folder_ / "a.bin") << "old";
  fs::permissions(folder_ / "a.bin", only_mine);
  auto out = OutputFile::create(folder_ / "a.bin");
  ASSERT_TRUE(out) << out.error().line();
  out->write("new");
  ASSERT_TRUE(out->commit());
  EXPECT_EQ(*read_file(folder_ / "a.bin"), "new");
  EXPECT_EQ(fs::status(folder_ / "a.bin").permissions(), only_mine);
}

// Two outputs of one process under one name stand for a run that was killed, with the same process number.
TEST_F(File, what_a_killed_run_left_is_named) {
  std::ofstream(folder_ / ("." + std::string("a.bin.") + std::to_string(::getpid()) + ".tmp")) << "left";
  auto out = OutputFile::create(folder_ / "a.bin");  // where there are no nameless files, this fails already
  const Result<void> done = out ? out->commit() : fail(out.error());
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().line().find("is in the way, left by a run that was killed; remove it"), std::string::npos);
}

TEST_F(File, a_symbolic_link_stays_and_its_target_gets_the_bytes) {
  fs::create_directories(folder_ / "far");
  std::ofstream(folder_ / "far" / "a.bin") << "old";
  fs::create_symlink("far/a.bin", folder_ / "there");
  fs::create_symlink("there", folder_ / "twice");
  fs::create_symlink("far/b.bin", folder_ / "dangling");
  for (const char* name : {"twice", "dangling"}) {
    auto out = OutputFile::create(folder_ / name);
    ASSERT_TRUE(out) << out.error().line();
    out->write("new");
    ASSERT_TRUE(out->commit());
    EXPECT_TRUE(fs::is_symlink(folder_ / name)) << name;
  }
  EXPECT_TRUE(fs::is_symlink(folder_ / "there"));
  for (const char* name : {"a.bin", "b.bin"}) EXPECT_EQ(*read_file(folder_ / "far" / name), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "far"), fs::directory_iterator()), 2);
}

TEST_F(File, links_that_lead_to_no_file_are_refused) {
  fs::create_symlink("no/a.bin", folder_ / "nowhere");
  fs::create_symlink("circle", folder_ / "circle");
  fs::create_symlink("/dev/null", folder_ / "null");
  const std::pair<const char*, const char*> cases[] = {
      {"nowhere", "no/a.bin, which is in no existing folder"}, {"circle", "circle"}, {"null", "not a regular file"}};
  for (const auto& [name, part] : cases) {
    const auto out = OutputFile::create(folder_ / name);
    ASSERT_FALSE(out) << name;
    EXPECT_NE(out.error().line().find(part), std::string::npos) << out.error().line();
  }
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

TEST_F(Staging, links_stay_and_lead_to_the_new_bytes) {
  const fs::path far = folder_ / "far";
  fs::create_directories(far);
  put(far / "b", "old b");
  fs::create_symlink("far/b", folder_ / "b");
  fs::create_symlink("far/d", folder_ / "d");
  {
    StagingFolder staging = staged();
    ASSERT_TRUE(staging.commit());
  }
  for (const char* name : {"a", "b", "c", "d"}) EXPECT_EQ(*read_file(folder_ / name), std::string("new ") + name);
  for (const char* name : {"b", "d"}) EXPECT_TRUE(fs::is_symlink(folder_ / name));
  EXPECT_EQ(std::distance(fs::directory_iterator(far), fs::directory_iterator()), 2);
  EXPECT_EQ(entries(), 5U);
}

TEST_F(Staging, replaced_files_keep_their_permissions) {
  const fs::perms only_mine = fs::perms::owner_read | fs::perms::owner_write;
  put(folder_ / "b", "old b");
  fs::permissions(folder_ / "b", only_mine);
  {
    StagingFolder staging = staged();
    ASSERT_TRUE(staging.commit());
  }
  EXPECT_EQ(*read_file(folder_ / "b"), "new b");
  EXPECT_EQ(fs::status(folder_ / "b").permissions(), only_mine);
}

TEST_F(Staging, one_write_protected_file_changes_none) {
  fs::create_symlink("far", folder_ / "b");
  put(folder_ / "far", "old far");
  put(folder_ / "d", "old d");
  fs::permissions(folder_ / "d", fs::perms::owner_read);
  {
    StagingFolder staging = staged();
    const auto done = staging.commit();
    ASSERT_FALSE(done);
    EXPECT_NE(done.error().line().find("d: is write-protected"), std::string::npos);
  }
  EXPECT_EQ(*read_file(folder_ / "a"), "old a");
  EXPECT_EQ(*read_file(folder_ / "far"), "old far");
  EXPECT_EQ(entries(), 5U);
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
