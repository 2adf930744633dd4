#include "lodestone/report/html_text.h"

#include <gtest/gtest.h>

namespace lodestone::report {
namespace {

TEST(HtmlText, makes_text_from_outside_harmless) {
  EXPECT_EQ(escaped("<script>alert('x')</script> & \"y\""),
            "&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt; &amp; &quot;y&quot;");
  EXPECT_EQ(escaped("a\nb\tc\x7f"), "a b c ");
  EXPECT_EQ(escaped("Bogenbrücke €𝄞"), "Bogenbrücke €𝄞");
  EXPECT_EQ(escaped(std::string_view("\0", 1)), " ");
}

TEST(HtmlText, bytes_that_are_not_utf8) {
  const std::string mark = "\xEF\xBF\xBD";
  EXPECT_EQ(escaped("\xff<"), mark + "&lt;");
  EXPECT_EQ(escaped("\xc0\xaf"), mark + mark);             // overlong
  EXPECT_EQ(escaped("\xed\xa0\x80"), mark + mark + mark);  // a surrogate
  EXPECT_EQ(escaped("\xe2\x82"), mark + mark);             // cut off
}

}  // namespace
}  // namespace lodestone::report
