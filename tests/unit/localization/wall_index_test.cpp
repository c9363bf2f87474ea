#include "localization/drawing_fit/wall_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/angle.hpp"
#include "tests/support/made_up_buildings.hpp"

namespace madori::localization {
namespace {

int by_arc_tangent(double normal_x, double normal_y) {
  double angle = std::atan2(normal_y, normal_x);
  if (angle < 0.0) angle += kPi;
  return std::min(static_cast<int>(angle / (kPi / WallIndex::kDirections)), WallIndex::kDirections - 1);
}

TEST(WallIndex, DirectionsAreThoseOfTheArcTangent) {
  for (int x = -1; x <= 1; ++x)  // where directions meet
    for (int y = -1; y <= 1; ++y)
      if (x != 0 || y != 0) {
        EXPECT_EQ(WallIndex::direction_of(x, y), by_arc_tangent(x, y)) << x << ", " << y;
      }
  EXPECT_EQ(WallIndex::direction_of(-1.0, -0.0), by_arc_tangent(-1.0, -0.0));
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> turn(-kPi, kPi);
  for (int i = 0; i < 100'000; ++i) {
    const double angle = turn(engine);
    ASSERT_EQ(WallIndex::direction_of(std::cos(angle), std::sin(angle)),
              by_arc_tangent(std::cos(angle), std::sin(angle)))
        << angle;
  }
}

TEST(WallIndex, ARowOfShiftsSeesWhatEachPlaceSees) {
  const WallIndex index(test::laboratory_hall());
  std::vector<double> shifts;
  for (int i = -60; i <= 60; ++i) shifts.push_back(0.37 * i);
  std::mt19937 engine(2);
  std::uniform_real_distribution<double> x(-5.0, 25.0), y(-5.0, 15.0);
  std::size_t seen = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const double x_m = x(engine), y_m = y(engine);
    const int direction = trial % WallIndex::kDirections;
    std::vector<int> found(shifts.size(), 255);
    index.for_each_shift(x_m, y_m, direction, shifts, [&](std::size_t i, int centimetres) {
      found[i] = centimetres;
      ++seen;
    });
    for (std::size_t i = 0; i < shifts.size(); ++i)
      ASSERT_EQ(found[i], index.centimetres(x_m + shifts[i], y_m, direction));
  }
  EXPECT_GT(seen, 1000u);
}

}  // namespace
}  // namespace madori::localization
