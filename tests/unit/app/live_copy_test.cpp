#include "app/panel/live_copy.hpp"

#include <gtest/gtest.h>

#include "app/lidars.hpp"
#include "app/panel/reference_lidar.hpp"
#include "tests/unit/app/corridor_vehicle.hpp"

namespace madori::app {
namespace {

/// What the panel is told of the place after half a second in this state.
hmi::LocateView told(LocalizationState state, std::vector<PoseHypothesis> places, bool lidar_silent = false) {
  const auto vehicle = test::corridor_vehicle();
  vehicle->pose->state = state;
  vehicle->pose->places = std::move(places);
  vehicle->lidar_silent = lidar_silent;
  LiveCopy copy;
  vehicle->on_step = [&](const CycleInput& input, const CycleOutput&, const CycleState& now) {
    copy.show(input, now, vehicle->config, "");
  };
  vehicle->run_until([] { return false; }, 1.2);
  return copy.locate();
}

/// Two places of 93 and 85 %: who stands there learns nothing more by waiting.
TEST(LiveCopy, APersonIsAskedAsSoonAsPlacesAreRankedHoweverUnsureTheyAre) {
  const std::vector<PoseHypothesis> two{{{1.0, 0.0, 0.0}, 0.15, 0.93}, {{9.0, 0.0, 0.0}, 0.14, 0.85}};
  for (const auto state : {LocalizationState::Lost, LocalizationState::Ambiguous}) {
    const auto locate = told(state, two);
    EXPECT_EQ(locate.state, "ambiguous");
    ASSERT_EQ(locate.places.size(), 2U);
    EXPECT_EQ(locate.places.front().score, 0.93);
  }
  EXPECT_EQ(told(LocalizationState::Localized, two).state, "located");
  EXPECT_EQ(told(LocalizationState::Lost, {}).state, "searching");
  EXPECT_EQ(told(LocalizationState::Lost, two, true).state, "blind");
}

/// Steps of the set-up are missing: nothing is compared yet, and the lidar is not to blame.
TEST(LiveCopy, WhileTheSiteIsSetUpTheLidarIsBlamedOnlyWhenItIsSilent) {
  const auto vehicle = test::corridor_vehicle();
  LiveCopy copy;
  vehicle->on_step = [&](const CycleInput& input, const CycleOutput&, const CycleState&) {
    copy.show_setup(input, {lidar_model(reference_lidar())}, "");
  };
  vehicle->run_until([] { return false; }, 0.6);
  EXPECT_EQ(copy.locate().state, "setting-up");
  vehicle->lidar_silent = true;
  vehicle->run_until([] { return false; }, 1.0);
  EXPECT_EQ(copy.locate().state, "blind");
}

/// The set-up may be complete, and the vehicle moves: every other tablet has to know.
TEST(LiveCopy, WhileTheMountingsAreMeasuredThatIsSaidAndNotThatTheSetUpIsOpen) {
  const auto vehicle = test::corridor_vehicle();
  LiveCopy copy;
  vehicle->on_step = [&](const CycleInput& input, const CycleOutput&, const CycleState&) {
    copy.show_measuring(input, {lidar_model(reference_lidar())}, "");
  };
  vehicle->run_until([] { return false; }, 0.6);
  const auto live = copy.live();
  EXPECT_EQ(live.state, "measuring");
  EXPECT_EQ(live.cause.code, "measuring");
  EXPECT_EQ(live.remedy.code, "wait-or-stop");
  EXPECT_EQ(copy.locate().state, "searching");
}

}  // namespace
}  // namespace madori::app
