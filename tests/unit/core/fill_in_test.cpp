#include "core/fill_in.hpp"

#include <gtest/gtest.h>

namespace madori {
namespace {

TEST(FillIn, EveryPlaceholderIsReplacedAndValuesAreNotSearchedAgain) {
  EXPECT_EQ(fill_in("{a} and {b}, {a}", {{"a", "1"}, {"b", "two"}}), "1 and two, 1");
  EXPECT_EQ(fill_in("{a}", {{"a", "{a}"}}), "{a}");
  EXPECT_EQ(fill_in("{left} stays", {{"right", "x"}}), "{left} stays");
  EXPECT_EQ(fill_in("{a}{a}", {{"a", ""}}), "");
}

TEST(FillIn, NumbersHaveTwoDecimals) {
  EXPECT_EQ(two_decimals(0.0), "0.00");
  EXPECT_EQ(two_decimals(-1.005), "-1.00");
  EXPECT_EQ(two_decimals(12.346), "12.35");
}

}  // namespace
}  // namespace madori
