#include "hmi/server/scan_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace madori::hmi {
namespace {

struct Decoded {
  std::uint32_t count = 0;
  double x = 0, y = 0, yaw = 0;
  float unit = 0;
  std::vector<Point2<Base>> points;
};

/// As a browser reads it.
Decoded decode(const std::string& frame) {
  Decoded d;
  EXPECT_EQ(frame.substr(0, 4), "MDS2");
  std::memcpy(&d.count, frame.data() + 4, 4);
  std::memcpy(&d.x, frame.data() + 8, 8);
  std::memcpy(&d.y, frame.data() + 16, 8);
  std::memcpy(&d.yaw, frame.data() + 24, 8);
  std::memcpy(&d.unit, frame.data() + 32, 4);
  EXPECT_EQ(frame.size(), 36U + 4U * d.count);
  for (std::uint32_t i = 0; i < d.count; ++i) {
    std::int16_t xy[2];
    std::memcpy(xy, frame.data() + 36 + 4 * i, 4);
    d.points.push_back({xy[0] * static_cast<double>(d.unit), xy[1] * static_cast<double>(d.unit)});
  }
  return d;
}

TEST(ScanFrame, EveryPointComesBackWithinHalfAUnit) {
  std::mt19937 random(3);  // NOLINT: a fixed seed
  for (const double reach_m : {5.0, 120.0, 900.0}) {
    std::uniform_real_distribution<double> place(-reach_m, reach_m);
    std::vector<Point2<Base>> scan(500);
    for (auto& p : scan) p = {place(random), place(random)};
    const Decoded d = decode(scan_frame(scan, {1e5, -3.25, 2.5}));
    EXPECT_DOUBLE_EQ(d.x, 1e5);
    EXPECT_DOUBLE_EQ(d.y, -3.25);
    EXPECT_DOUBLE_EQ(d.yaw, 2.5);
    ASSERT_EQ(d.points.size(), scan.size());
    for (std::size_t i = 0; i < scan.size(); ++i) {
      EXPECT_NEAR(d.points[i].x_m, scan[i].x_m, 0.51 * static_cast<double>(d.unit));
      EXPECT_NEAR(d.points[i].y_m, scan[i].y_m, 0.51 * static_cast<double>(d.unit));
    }
  }
}

TEST(ScanFrame, NonFinitePointsAreLeftOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<Point2<Base>> scan{{nan, 1.0}, {1.0, 2.0}, {inf, 0.0}, {0.0, -inf}};
  const Decoded d = decode(scan_frame(scan, {}));
  ASSERT_EQ(d.points.size(), 1U);
  EXPECT_NEAR(d.points[0].y_m, 2.0, 0.005);
}

TEST(ScanFrame, AThinnedFrameKeepsTheHeadAndAnEvenChoice) {
  std::vector<Point2<Base>> scan;
  for (int i = 0; i < 1001; ++i) scan.push_back({0.1 * i, 0.0});
  const std::string frame = scan_frame(scan, {1.0, 2.0, 3.0});
  const Decoded thin = decode(thinned_scan_frame(frame, 100));
  EXPECT_LE(thin.count, 100U);
  EXPECT_GE(thin.count, 50U);
  EXPECT_DOUBLE_EQ(thin.yaw, 3.0);
  for (std::size_t i = 1; i < thin.points.size(); ++i)
    EXPECT_NEAR(thin.points[i].x_m - thin.points[i - 1].x_m, thin.points[1].x_m, 0.011);
  EXPECT_EQ(thinned_scan_frame(frame, 2000), frame);
  EXPECT_EQ(decode(thinned_scan_frame("short", 10)).count, 0U);
}

}  // namespace
}  // namespace madori::hmi
