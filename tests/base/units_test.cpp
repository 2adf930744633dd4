#include "lodestone/base/units.h"

#include <gtest/gtest.h>

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
