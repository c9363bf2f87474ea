#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "app/cycle/stages.hpp"
#include "core/angle.hpp"
#include "tests/support/toy_vehicle.hpp"

namespace madori::app {
namespace {

/// A vehicle that works on an order; what is asked of its drive and where it gets to are told.
class Working {
 public:
  Working() : state_(config_, nullptr) {
    state_.mode = Mode::Driving;
    state_.drive.state = control::wire::DriveState::Running;
    state_.pose.health.state = LocalizationState::Localized;
  }

  /// True where the vehicle is said to be held meanwhile. What the wheels are said to do: what it does.
  bool drive(double asked_mps, double moved_mps, double seconds) {
    return drive(asked_mps, moved_mps, seconds, moved_mps);
  }
  bool drive(double asked_mps, double moved_mps, double seconds, double told_mps) {
    constexpr double kStepS = 0.02;
    bool held = false;
    for (int i = 0; i < static_cast<int>(seconds / kStepS); ++i) {
      status_.time_us += static_cast<std::uint32_t>(kStepS * 1e6);
      ++status_.sequence;
      turn_wheels(told_mps * kStepS);
      now_ += duration_from_seconds(kStepS);
      (void)state_.odometry.update(status_, now_);
      state_.pose.map_from_base =
          state_.pose.map_from_base * Transform2<Base, Base>(moved_mps * kStepS, 0.0, 0.0);
      state_.limits.previous = {asked_mps, 0.0};
      CycleOutput output;
      watch_effort(state_, {}, config_, output);
      held = held || !output.events.empty();
    }
    return held;
  }

  [[nodiscard]] const std::optional<control::DisobedientWheel>& disobedient() const {
    return state_.disobedient;
  }

 private:
  void turn_wheels(double way_m) {
    turned_rad_ += way_m / config_.odometry.wheels.left_radius_m;
    const double turns = turned_rad_ / (2.0 * kPi);
    status_.left_turns = status_.right_turns = static_cast<std::int16_t>(std::floor(turns));
    status_.left_angle = status_.right_angle =
        static_cast<std::uint16_t>((turns - std::floor(turns)) * control::wire::kCountsPerTurn);
  }

  CycleConfig config_ = test::toy_config({});
  CycleState state_;
  control::wire::Status status_;
  double turned_rad_ = 0.0;
  Stamp now_ = stamp_from_seconds(100.0);
};

TEST(WatchEffort, AVehicleThatStandsAgainstSomethingIsHeld) {
  Working vehicle;
  EXPECT_FALSE(vehicle.drive(0.3, 0.3, 5.0));
  EXPECT_FALSE(vehicle.drive(0.3, 0.0, 1.5));
  EXPECT_TRUE(vehicle.drive(0.3, 0.0, 2.0));
}

TEST(WatchEffort, BackAStepAndOnAgainIsNotHeld) {
  Working vehicle;
  EXPECT_FALSE(vehicle.drive(-0.05, -0.05, 1.5));
  EXPECT_FALSE(vehicle.drive(0.05, 0.05, 1.5));  // where it began, after three seconds of driving
  EXPECT_FALSE(vehicle.drive(0.05, 0.05, 3.0));
}

TEST(WatchEffort, AVehicleHeldBothWaysIsHeld) {
  Working vehicle;
  EXPECT_TRUE(vehicle.drive(-0.1, 0.0, 3.0));
  EXPECT_TRUE(vehicle.drive(0.1, 0.0, 3.0));
}

TEST(WatchEffort, EncodersThatStandWhileTheVehicleGetsOnAreNamed) {
  Working vehicle;
  EXPECT_FALSE(vehicle.drive(1.0, 1.0, 5.0));
  EXPECT_FALSE(vehicle.disobedient());
  EXPECT_FALSE(vehicle.drive(1.0, 1.0, 1.8, 0.0));
  EXPECT_FALSE(vehicle.disobedient());
  EXPECT_FALSE(vehicle.drive(1.0, 1.0, 0.5, 0.0));
  ASSERT_TRUE(vehicle.disobedient());
  EXPECT_EQ(vehicle.disobedient()->turned_mps, 0.0);
  EXPECT_EQ(vehicle.disobedient()->asked_mps, 1.0);
}

/// The place that localization knows moves by so much at once, not more.
TEST(WatchEffort, AHeldVehicleWhosePlaceIsCorrectedHasGoodEncoders) {
  Working vehicle;
  EXPECT_FALSE(vehicle.drive(0.3, 0.3, 5.0));
  (void)vehicle.drive(0.3, 1.0, 0.3, 0.0);
  EXPECT_TRUE(vehicle.drive(0.3, 0.0, 10.0));
  EXPECT_FALSE(vehicle.disobedient());
}

}  // namespace
}  // namespace madori::app
