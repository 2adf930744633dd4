#include "lodestone/base/units.h"

#include <gtest/gtest.h>

#include "support/comma_locale.h"

namespace lodestone {
namespace {

TEST(Units, lengths) {
  struct Case {
    const char* text;
    double value;
    Length::Kind kind;
  };
  for (const Case& c : {Case{"0.001", 0.001, Length::Kind::relative}, Case{"0.1%", 0.001, Length::Kind::relative},
                        Case{"2mm", 0.002, Length::Kind::metres}, Case{"0.5m", 0.5, Length::Kind::metres},
                        Case{"1e-3", 0.001, Length::Kind::relative}, Case{"1in", 0.0254, Length::Kind::metres}}) {
    const auto length = parse_length(c.text);
    ASSERT_TRUE(length) << c.text;
    EXPECT_DOUBLE_EQ(length->value, c.value) << c.text;
    EXPECT_EQ(length->kind, c.kind) << c.text;
  }
  for (const char* text : {"", "x", "-1", "nan", "inf", "3 parsec", "1mmm"}) EXPECT_FALSE(parse_length(text)) << text;
}

TEST(Units, a_program_with_a_decimal_comma_changes_no_number) {
  const test::CommaLocale comma;
  if (!comma.of_c()) GTEST_SKIP() << "this system makes no locale (localedef)";
  ASSERT_TRUE(parse_length("0.5mm") && parse_length("0.1%"));
  EXPECT_DOUBLE_EQ(parse_length("0.5mm")->value, 0.0005);
  EXPECT_DOUBLE_EQ(parse_length("0.1%")->value, 0.001);
  EXPECT_DOUBLE_EQ(*parse_number("0.25"), 0.25);
  EXPECT_EQ(short_number(0.25), "0.25");
  EXPECT_EQ(percent(0.125), "12.5 %");
  EXPECT_EQ(human_bytes(3'400'000), "3.4 MB");
}

TEST(Units, a_number_at_the_head_of_a_text) {
  const auto length = leading_number("1.5mm");
  ASSERT_TRUE(length);
  EXPECT_EQ(length->value, 1.5);
  EXPECT_EQ(length->rest, "mm");
  EXPECT_EQ(leading_number("-2e3")->value, -2000);
  EXPECT_EQ(leading_number("-2e3")->rest, "");
  for (const char* text : {"", "mm", "nan", "inf", "1e999", " 1", "0x10mm"}) {
    const auto number = leading_number(text);
    EXPECT_TRUE(!number || (number->value == 0 && number->rest == "x10mm")) << text;
  }
}

TEST(Units, numbers_for_people) {
  EXPECT_EQ(with_separators(0), "0");
  EXPECT_EQ(with_separators(999), "999");
  EXPECT_EQ(with_separators(1000), "1,000");
  EXPECT_EQ(with_separators(1234567), "1,234,567");
  EXPECT_EQ(human_bytes(999), "999 B");
  EXPECT_EQ(human_bytes(3'400'000), "3.4 MB");
  EXPECT_EQ(human_bytes(999'999), "1.0 MB");
}

TEST(Units, an_error_is_one_line) {
  const Error error{ErrorCode::bad_format, "what\nnow", "a\tb.ply", "do this"};
  EXPECT_EQ(error.line(), "a?b.ply: what?now; do this");
}

}  // namespace
}  // namespace lodestone
