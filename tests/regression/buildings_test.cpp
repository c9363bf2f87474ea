#include <gtest/gtest.h>

#include <filesystem>

#include "tests/bench/buildings/building_drive.hpp"

namespace madori::bench {
namespace {

/// Real drawings, true walls beside them by up to 0.25 m (hotel_L1) and 1.5 m (intel). A start without a
/// pose, one lap through all stations, at most one tap: the first lap is the one on which nothing is known
/// yet.
class Buildings : public testing::TestWithParam<const char*> {};

TEST_P(Buildings, AreDrivenFromTheirDrawing) {
  const std::filesystem::path data = std::filesystem::path(MADORI_SHARED_DATA) / "buildings";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is not here";
  const auto starts = list_starts(data, GetParam());
  ASSERT_EQ(starts.size(), 1U);
  DriveOptions options;
  options.laps = 1;
  const DriveFigures f = BuildingDrive(starts.front(), options).drive();
  EXPECT_EQ(delivered(f), f.asked) << testing::PrintToString(f.undelivered);
  EXPECT_LE(f.taps, 1);
  EXPECT_TRUE(f.helps.empty()) << testing::PrintToString(f.helps);
  EXPECT_TRUE(f.collisions_moving.empty()) << testing::PrintToString(f.collisions_moving);
  for (const PoseSample& s : f.samples) {
    if (s.state != LocalizationState::Localized) continue;
    ASSERT_LT(distance_m(s.pose.translation(), s.truth.translation()), 1.0) << "at " << s.time_s << " s";
  }
}

INSTANTIATE_TEST_SUITE_P(NotAsDrawn, Buildings, testing::Values("hotel_L1/start2", "intel/start0"));

}  // namespace
}  // namespace madori::bench
