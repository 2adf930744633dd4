#include "lodestone/io/images/encode.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "lodestone/base/file.h"
#include "lodestone/io/images/decode.h"

namespace lodestone {
namespace {

Pixels picture(std::uint8_t alpha) {
  Pixels pixels{7, 5, {}};
  for (std::uint32_t i = 0; i < 35; ++i) {
    const auto value = static_cast<std::uint8_t>(i * 7);
    pixels.rgba.insert(pixels.rgba.end(),
                       {value, static_cast<std::uint8_t>(255 - value), 90, i == 3 ? alpha : std::uint8_t{255}});
  }
  return pixels;
}

class WrittenPicture : public ::testing::TestWithParam<const char*> {
 protected:
  std::filesystem::path path() const {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("lodestone_") + test->name() + GetParam();
    for (char& c : name) c = c == '/' ? '_' : c;
    return std::filesystem::temp_directory_path() / name;
  }
  void TearDown() override { std::filesystem::remove(path()); }
};

TEST_P(WrittenPicture, ComesBackPixelForPixel) {
  for (const int alpha : {255, 40}) {
    const Pixels before = picture(static_cast<std::uint8_t>(alpha));
    const Result<std::uint64_t> bytes = io::write_picture(before, path());
    ASSERT_TRUE(bytes.has_value()) << bytes.error().line();
    const std::string file = read_file(path()).value();
    EXPECT_EQ(file.size(), *bytes);
    Image image;
    const auto raw = std::as_bytes(std::span(file));
    image.encoded.assign(raw.begin(), raw.end());
    const Result<Pixels> after = io::decode_image(image);
    ASSERT_TRUE(after.has_value());
    EXPECT_EQ(after->width, before.width);
    EXPECT_EQ(after->rgba, before.rgba);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, WrittenPicture, ::testing::Values(".png", ".webp", ".PNG"));

TEST(WritePicture, RefusesWhatItCannot) {
  EXPECT_EQ(io::write_picture(picture(255), "a.jpg").error().code, ErrorCode::bad_argument);
  EXPECT_EQ(io::write_picture(Pixels{}, "a.png").error().code, ErrorCode::bad_argument);
  EXPECT_EQ(io::write_picture(picture(255), "no/such/folder/a.png").error().code, ErrorCode::cannot_write);
}

}  // namespace
}  // namespace lodestone
