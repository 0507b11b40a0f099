// SPDX-License-Identifier: Apache-2.0
#include "proto/base/text.h"

#include <gtest/gtest.h>

namespace corridor {
namespace {

TEST(Grouped, PutsACommaBeforeEveryThreeDigits) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1,000");
  EXPECT_EQ(grouped(1'400'000), "1,400,000");
  EXPECT_EQ(grouped(-123), "-123");
  EXPECT_EQ(grouped(-123'456), "-123,456");
}

TEST(DurationText, ChoosesTheUnitsByLengthAndRoundsBeforeItDoes) {
  EXPECT_EQ(duration_text(0.4), "0 s");
  EXPECT_EQ(duration_text(59.6), "1 min 00 s");
  EXPECT_EQ(duration_text(67), "1 min 07 s");
  EXPECT_EQ(duration_text(3599.9), "1 h 00 min");
  EXPECT_EQ(duration_text(4000), "1 h 06 min");
}

TEST(ParseNumber, TakesTheWholeTextOrNothing) {
  EXPECT_EQ(parse_number<std::int64_t>("-12"), -12);
  EXPECT_EQ(parse_number<double>("1.5"), 1.5);
  for (const char* text : {"", " 1", "1 ", "1x", "x", "-1", "99999999999999999999"}) {
    EXPECT_FALSE(parse_number<std::uint64_t>(text)) << text;
  }
}

TEST(Listed, PutsCommasBetween) {
  EXPECT_EQ(listed(std::vector<int>{}), "");
  EXPECT_EQ(listed(std::vector{"a"}), "a");
  EXPECT_EQ(listed(std::vector{"a", "b", "c"}), "a, b, c");
  EXPECT_EQ(listed(std::vector{"", "b"}, "-"), "-b");
}

TEST(Replaced, IsTheTextWithAnotherInPlaceOfEachCharacter) {
  EXPECT_EQ(replaced("a|b||", '|', "\\|"), "a\\|b\\|\\|");
  EXPECT_EQ(replaced("", '|', "x"), "");
}

}  // namespace
}  // namespace corridor
