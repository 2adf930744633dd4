#include "app/options/numbers.h"

#include <gtest/gtest.h>

#include <string>

namespace lodestone::app {
namespace {

// "-" for what is no count, "many" for what is too large.
std::string count_text(std::string_view text) {
  const std::optional<Count> count = count_in(text);
  if (!count) return "-";
  return count->too_large ? "many" : std::to_string(count->value);
}

TEST(Numbers, counts_are_read_as_people_write_them) {
  const std::pair<const char*, const char*> cases[] = {
      {"0", "0"},          {"5000", "5000"},     {"5k", "5000"},
      {"5K", "5000"},      {"1.1k", "1100"},     {"1.5M", "1500000"},
      {"2M", "2000000"},   {"2G", "2000000000"}, {"1e4", "10000"},
      {"2.5e3", "2500"},   {"5,000", "5000"},    {"1,234,567", "1234567"},
      {"12,500", "12500"}, {"007", "7"},         {"1e19", "10000000000000000000"}};
  for (const auto& [text, value] : cases) EXPECT_EQ(count_text(text), value) << text;
  EXPECT_EQ(count_text("18446744073709551615"), "18446744073709551615");
}

TEST(Numbers, what_is_no_whole_number_is_no_count) {
  for (const char* text :
       {"",       "k",     "-5",   "5kk", "5 k",       "1.5",  "1.0005k", "1e-3", "5m",   "5,00",
        "5,0000", "0,500", ",000", "5,",  "5.000,000", "0x10", "inf",     "nan",  "many", "5k,000"}) {
    EXPECT_EQ(count_text(text), "-") << text;
  }
  for (const char* text : {"18446744073709551616", "1e20", "99999999999G", "99,999,999,999,999,999,999"}) {
    EXPECT_EQ(count_text(text), "many") << text;
  }
}

TEST(Numbers, a_comma_that_was_meant_as_a_point_is_seen) {
  const std::pair<const char*, const char*> meant[] = {
      {"0,1%", "0.1%"}, {"0,5", "0.5"}, {"1,5%", "1.5%"}, {"1,5mm", "1.5mm"}, {"0,05%,0,2%", "0.05%,0.2%"},
      {"00,5", "00.5"}};
  for (const auto& [text, with_point] : meant) EXPECT_EQ(with_decimal_point(text), with_point) << text;
  for (const char* text : {"", "5", "0.1%", "50%,10%", "1%,2%", "0.05%,0.2%,1%", "2,10", "0.5,0.25", "2mm,10mm",
                           "0.001,1%", "0", "1,2e-3"}) {
    EXPECT_EQ(with_decimal_point(text), "") << text;
  }
}

TEST(Numbers, commas_of_thousands_in_a_list_of_counts_are_seen) {
  const std::pair<const char*, const char*> meant[] = {{"5,000", "5000"},
                                                       {"12,500", "12500"},
                                                       {"20,000,5,000", "20000,5000"},
                                                       {"1,234,567", "1234,567"},
                                                       {"9000,5,050", "9000,5050"}};
  for (const auto& [text, joined] : meant) EXPECT_EQ(without_thousands(text), joined) << text;
  for (const char* text : {"", "5000", "5000,1000,200", "500,100", "5k,1k,100", "10000,1e3", "1000,100"}) {
    EXPECT_EQ(without_thousands(text), "") << text;
  }
}

}  // namespace
}  // namespace lodestone::app
