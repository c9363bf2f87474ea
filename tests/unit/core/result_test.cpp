#include "core/result.hpp"

#include <gtest/gtest.h>

namespace madori {
namespace {

TEST(Result, HoldsAValueOrAReason) {
  const Result<int> good(7);
  ASSERT_TRUE(good.ok());
  EXPECT_EQ(good.value(), 7);
  const auto bad = Result<int>::failure("no echo");
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.reason(), "no echo");
}

TEST(Error, NamesPlaceCauseAndMend) {
  EXPECT_STREQ(Error("plan.png", "it is empty", "export it again").what(),
               "plan.png: it is empty - export it again");
}

}  // namespace
}  // namespace madori
