#include "lodestone/io/content.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "lodestone/base/file.h"
#include "lodestone/io/read.h"

namespace lodestone::io {
namespace {

using namespace std::string_view_literals;
namespace fs = std::filesystem;

class Contents : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string error_of(const std::string& name, std::string_view bytes) {
    Result<OutputFile> file = OutputFile::create(folder_ / name);
    file->write(bytes);
    EXPECT_TRUE(file->commit());
    const Result<Model> model = read_model(folder_ / name);
    return model ? std::string() : model.error().line();
  }

  fs::path folder_;
};

TEST_F(Contents, a_file_of_another_kind_is_called_by_its_name) {
  const std::pair<std::string_view, const char*> cases[] = {
      {"PK\x03\x04 and so on"sv, "ZIP archive"}, {"\x1f\x8b\x08 and so on"sv, "gzip"},
      {"\x89PNG\r\n\x1a\n"sv, "PNG picture"},    {"\xff\xd8\xff\xe0 JFIF"sv, "JPEG picture"},
      {"%PDF-1.4 and so on"sv, "PDF"},           {"\n <!DOCTYPE HTML><html>"sv, "web page"},
      {"<html><body>404"sv, "web page"},         {"version https://git-lfs.github.com/spec/v1\n"sv, "git lfs pull"}};
  for (const auto& [bytes, told] : cases) {
    for (const char* name : {"a.glb", "a.gltf", "a.ply", "a.obj", "a.stl", "a.off"}) {
      const std::string line = error_of(name, bytes);
      EXPECT_NE(line.find(told), std::string::npos) << name << ": " << line;
      EXPECT_NE(line.find("looks like"), std::string::npos) << name << ": " << line;
    }
  }
  EXPECT_NE(error_of("a.ply", "{\"asset\": {}}").find("looks like JSON, not .ply"), std::string::npos);
}

TEST_F(Contents, a_model_with_the_wrong_ending_is_told_the_right_one) {
  EXPECT_NE(error_of("a.ply", "OFF\n0 0 0\n").find("rename it to end in .off"), std::string::npos);
  EXPECT_NE(error_of("a.obj", "LASF and so on").find("rename it to end in .las"), std::string::npos);
  std::string stl(84 + 50, '\0');
  stl[80] = 1;
  EXPECT_NE(error_of("a.ply", stl).find("rename it to end in .stl"), std::string::npos);
  EXPECT_NE(error_of("model", "ply\nformat").find("has no extension but holds PLY"), std::string::npos);
  EXPECT_NE(error_of("model.zip", "PK\x03\x04").find("unpack it"), std::string::npos);
}

TEST_F(Contents, what_the_right_reader_refuses_keeps_its_own_words) {
  EXPECT_NE(error_of("a.gltf", "{\"a\": 1}").find("asset.version"), std::string::npos);
  EXPECT_NE(error_of("a.ply", "ply\nformat teapot\n").find("a.ply"), std::string::npos);
  EXPECT_EQ(error_of("a.ply", "ply\nformat teapot\n").find("looks like"), std::string::npos);
  EXPECT_EQ(error_of("a.obj", "# no faces\nv 0 0 0\n").find("looks like"), std::string::npos);
}

TEST_F(Contents, a_header_that_looks_like_something_else_does_no_harm) {
  // The first 80 bytes of a binary STL are anybody's.
  std::string stl(84 + 50, '\0');
  stl.replace(0, 4, "PK\x03\x04");
  stl[80] = 1;
  const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  stl.replace(84 + 12, sizeof corners, reinterpret_cast<const char*>(corners), sizeof corners);
  EXPECT_EQ(error_of("a.stl", stl), "");
}

}  // namespace
}  // namespace lodestone::io
