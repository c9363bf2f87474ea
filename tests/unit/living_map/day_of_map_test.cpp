#include "app/learned/day_of_map.hpp"

#include <gtest/gtest.h>

#include "core/result.hpp"

namespace madori::app {
namespace {

using localization::HybridMap;
using localization::MapCell;
using mapping::DayState;

constexpr Duration kDay = std::chrono::hours(24);
constexpr Stamp kMorning = Stamp(20'000 * kDay + std::chrono::hours(8));

MapCell cell(float now, float stands, float permanent, Stamp seen) {
  MapCell made;
  made.layers = {now, stands, permanent, seen};
  return made;
}

/// One cell of each state, seen at `kMorning` or before.
HybridMap one_of_each() {
  HybridMap map;
  map.restore({-3, 5}, cell(2.8F, 1.4F, 4.0F, kMorning));                         // static
  map.restore({-2, 5}, cell(2.8F, 1.4F, 0.0F, kMorning));                         // semi-static
  map.restore({-1, 5}, cell(2.8F, -1.0F, 0.0F, kMorning));                        // moving
  map.restore({0, 5}, cell(-2.8F, -1.4F, 0.0F, kMorning));                        // free
  map.restore({1, 5}, cell(-2.8F, 0.0F, 4.0F, kMorning));                         // taken away
  map.restore({2, 6}, cell(2.8F, 1.4F, 4.0F, kMorning - std::chrono::hours(9)));  // static, of yesterday
  return map;
}

TEST(DayOfMap, ReadsEachCellAndHowLongAgoItWasSeen) {
  const auto day = day_of(one_of_each(), "0123456789abcdef", Duration(0));
  ASSERT_TRUE(day);
  EXPECT_EQ(mapping::to_text(day->day), "2024-10-04");
  EXPECT_EQ(day->width, 6);
  EXPECT_EQ(day->height, 2);
  EXPECT_EQ(day->cell_m, 0.25);
  const std::vector<DayState> states{DayState::Static, DayState::SemiStatic, DayState::Moving,
                                     DayState::Free,   DayState::TakenAway,  DayState::Unseen};
  for (int i = 0; i < 6; ++i) EXPECT_EQ(day->at(i - 3, 5).state, states[static_cast<std::size_t>(i)]) << i;
  EXPECT_EQ(day->at(-3, 5).age_days, 0);
  EXPECT_EQ(day->at(2, 6), (mapping::DayCell{DayState::Static, 1}));
  EXPECT_NEAR(day->centre(2, 6).y_m, one_of_each().centre({2, 6}).y_m, 1e-12);
}

/// A computer that took 1970 for today when it started and was set since.
TEST(DayOfMap, TheDayIsThatOfTheTimeOfDay) {
  const auto day = day_of(one_of_each(), "0123456789abcdef", 700 * kDay);
  ASSERT_TRUE(day);
  EXPECT_EQ(mapping::to_text(day->day), "2026-09-04");
  EXPECT_EQ(day->at(2, 6).age_days, 1);
}

TEST(DayOfMap, NothingSeenIsNoDayAndTooFarApartIsRefused) {
  HybridMap map;
  EXPECT_FALSE(day_of(map, "0123456789abcdef", Duration(0)));
  map.restore({0, 0}, cell(2.8F, 1.4F, 4.0F, kMorning));
  map.restore({30'000, 600}, cell(2.8F, 1.4F, 4.0F, kMorning));
  EXPECT_THROW((void)day_of(map, "0123456789abcdef", Duration(0)), Error);
}

}  // namespace
}  // namespace madori::app
