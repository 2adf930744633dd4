#include "lodestone/io/images/decode.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "lodestone/base/file.h"

namespace lodestone::io {
namespace {

using Rgba = std::array<std::uint8_t, 4>;

std::string bytes_of(const std::string& name) {
  const auto seeds = std::filesystem::path(LODESTONE_SOURCE) / "fuzz/seeds/image_fuzz";
  Result<std::string> bytes = read_file(seeds / name);
  EXPECT_TRUE(bytes) << name;
  return bytes ? *bytes : std::string();
}

Image image_of(const std::string& bytes) {
  Image image;
  image.name = "picture";
  const auto raw = std::as_bytes(std::span(bytes));
  image.encoded.assign(raw.begin(), raw.end());
  return image;
}

TEST(DecodeImage, png_colours_palettes_and_deep_grey) {
  const auto two = decode_image(image_of(bytes_of("two.png")));
  ASSERT_TRUE(two) << two.error().line();
  EXPECT_EQ(two->width, 2U);
  EXPECT_EQ(two->height, 1U);
  EXPECT_EQ(two->at(0, 0), (Rgba{255, 0, 0, 255}));
  EXPECT_EQ(two->at(1, 0), (Rgba{0, 0, 255, 255}));

  const auto palette = decode_image(image_of(bytes_of("palette.png")));  // two colours, the first half transparent
  ASSERT_TRUE(palette) << palette.error().line();
  EXPECT_EQ(palette->at(0, 0), (Rgba{10, 20, 30, 128}));
  EXPECT_EQ(palette->at(1, 0), (Rgba{200, 210, 220, 255}));
  EXPECT_EQ(palette->at(0, 1), (Rgba{200, 210, 220, 255}));

  const auto grey = decode_image(image_of(bytes_of("grey16.png")));
  ASSERT_TRUE(grey) << grey.error().line();
  EXPECT_EQ(grey->at(1, 0), (Rgba{255, 255, 255, 255}));
  EXPECT_EQ(grey->at(0, 0)[0], grey->at(0, 0)[2]);
  EXPECT_LT(grey->at(0, 0)[0], 128);
}

TEST(DecodeImage, jpeg_and_webp) {
  const auto jpeg = decode_image(image_of(bytes_of("two.jpg")));  // 16 x 8, left (250, 20, 10), right (10, 20, 250)
  ASSERT_TRUE(jpeg) << jpeg.error().line();
  ASSERT_EQ(jpeg->width, 16U);
  ASSERT_EQ(jpeg->height, 8U);
  EXPECT_NEAR(jpeg->at(2, 3)[0], 250, 12);
  EXPECT_NEAR(jpeg->at(2, 3)[2], 10, 12);
  EXPECT_NEAR(jpeg->at(13, 3)[2], 250, 12);
  EXPECT_EQ(jpeg->at(0, 0)[3], 255);

  const auto webp = decode_image(image_of(bytes_of("two.webp")));
  ASSERT_TRUE(webp) << webp.error().line();
  ASSERT_EQ(webp->width, 2U);
  EXPECT_EQ(webp->at(0, 0), (Rgba{255, 0, 0, 255}));
  EXPECT_EQ(webp->at(1, 0), (Rgba{0, 0, 255, 128}));
}

TEST(DecodeImage, what_is_cut_off_or_damaged_is_an_error) {
  for (const char* name : {"two.png", "palette.png", "two.jpg", "two.webp", "lossy.webp"}) {
    const std::string whole = bytes_of(name);
    for (const std::size_t size : {whole.size() / 4, whole.size() / 2, whole.size() * 3 / 4}) {
      const auto pixels = decode_image(image_of(whole.substr(0, size)));
      ASSERT_FALSE(pixels) << name << " cut to " << size;
      EXPECT_EQ(pixels.error().code, ErrorCode::bad_format);
      EXPECT_EQ(pixels.error().where, "picture");
    }
  }
  const auto text = decode_image(image_of("no image at all"));
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, ErrorCode::bad_format);
  const auto gif = decode_image(image_of("GIF89a and so on"));
  ASSERT_FALSE(gif);
  EXPECT_EQ(gif.error().code, ErrorCode::unsupported);
  const auto missing = decode_image(Image{});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::empty);
}

// 66 bytes that claim 2^19 x 2^19 pixels, a terabyte: refused before memory is asked for.
TEST(DecodeImage, a_bomb_is_refused_by_what_it_claims) {
  const auto bomb = decode_image(image_of(bytes_of("bomb.png")));
  ASSERT_FALSE(bomb);
  EXPECT_EQ(bomb.error().code, ErrorCode::bad_format);
  EXPECT_NE(bomb.error().what.find("524288 x 524288"), std::string::npos) << bomb.error().what;
  EXPECT_FALSE(decode_image(image_of(bytes_of("two.jpg")), 127));
  EXPECT_TRUE(decode_image(image_of(bytes_of("two.jpg")), 128));
}

TEST(DecodeBaseColors, each_image_once_and_failures_told) {
  Model model;
  model.materials.resize(4);
  model.materials[0].base_color_texture = std::make_shared<Image>(image_of(bytes_of("two.png")));
  model.materials[1].base_color_texture = std::make_shared<Image>(image_of(bytes_of("two.png")));
  model.materials[2].base_color_texture = std::make_shared<Image>(image_of("no image at all"));
  std::vector<std::string> warnings;
  ASSERT_TRUE(decode_base_colors(model, warnings));
  ASSERT_NE(model.materials[0].base_color_pixels, nullptr);
  EXPECT_EQ(model.materials[0].base_color_pixels, model.materials[1].base_color_pixels);
  EXPECT_EQ(model.materials[2].base_color_pixels, nullptr);
  EXPECT_EQ(model.materials[3].base_color_pixels, nullptr);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("picture"), std::string::npos);
}

}  // namespace
}  // namespace lodestone::io
