#include "localization/drawing_fit/drawing_fit.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/angle.hpp"
#include "tests/support/made_up_buildings.hpp"

namespace madori::localization {
namespace {

/// Surfaces along y = y_m that look down.
MemoryCloud wall_seen_at(double y_m) {
  MemoryCloud cloud;
  for (double x = 0.0; x < 10.0; x += kVoxelM)
    cloud.push_back({x, y_m, 0.0, -1.0, 0, WallIndex::direction_of(0.0, -1.0), 1, 1.0, 1.0});
  return cloud;
}

TEST(DrawingFit, AWallBeyondTheWindowIsOfAnotherPlace) {
  const DrawingFit fit(mapping::Walls{{0, {{0.0, 0.0}, {10.0, 0.0}}}});
  const AlignmentWindow window{0.8, 0.09};
  const Alignment within = fit.align(wall_seen_at(-0.6), window);
  EXPECT_NEAR((within.correction * Point2<Map>{5.0, -0.6}).y_m, 0.0, 0.01);
  EXPECT_GT(within.gain, 3.0);
  const Alignment beyond = fit.align(wall_seen_at(-1.2), window);  // the window's edge lies 0.4 m before it
  EXPECT_NEAR((beyond.correction * Point2<Map>{5.0, -1.2}).y_m, -1.2, 0.81);
  EXPECT_LT(beyond.gain, 3.0);
}

TEST(DrawingFit, WhatItFindsLiesInItsWindow) {
  const DrawingFit fit(test::laboratory_hall());
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> x(0.0, 20.0), y(0.0, 10.0), turn(-kPi, kPi);
  for (int trial = 0; trial < 200; ++trial) {
    MemoryCloud cloud;
    for (int k = 0; k < 60; ++k) {
      const double angle = turn(engine), nx = std::cos(angle), ny = std::sin(angle);
      cloud.push_back({x(engine), y(engine), nx, ny, 0, WallIndex::direction_of(nx, ny), 1, 1.0, 1.0});
    }
    const AlignmentWindow window{0.1 + 0.005 * trial, 0.05};
    ASSERT_TRUE(window.contains(fit.align(cloud, window).correction, centre_of(cloud))) << trial;
  }
}

}  // namespace
}  // namespace madori::localization
