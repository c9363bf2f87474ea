#include "simulation/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace madori::simulation {
namespace {

TEST(Random, IsTheSameForTheSameSeedStreamAndCounterOnly) {
  EXPECT_EQ(Random(1, 2, 3).next(), Random(1, 2, 3).next());
  EXPECT_NE(Random(1, 2, 3).next(), Random(2, 2, 3).next());
  EXPECT_NE(Random(1, 2, 3).next(), Random(1, 3, 3).next());
  EXPECT_NE(Random(1, 2, 3).next(), Random(1, 2, 4).next());
}

TEST(Random, NormalNumbersHaveTheMomentsOfTheNormalDistribution) {
  Random random(7, 0, 0);
  constexpr int kDraws = 400'000;
  double sum = 0.0, squares = 0.0, fourth = 0.0;
  int beyond_two = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = normal_from_bits(static_cast<std::uint32_t>(random.next()));
    sum += x, squares += x * x, fourth += x * x * x * x;
    beyond_two += std::abs(x) > 2.0 ? 1 : 0;
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 0.006);
  EXPECT_NEAR(squares / kDraws, 1.0, 0.01);
  EXPECT_NEAR(fourth / kDraws, 3.0, 0.06);
  EXPECT_NEAR(beyond_two / static_cast<double>(kDraws), 0.0455, 0.0015);
}

}  // namespace
}  // namespace madori::simulation
