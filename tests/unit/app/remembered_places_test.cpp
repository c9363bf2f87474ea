#include <gtest/gtest.h>

#include <cmath>

#include "app/cycle/stages.hpp"
#include "tests/support/toy_vehicle.hpp"

namespace madori::app {
namespace {

/// Something low that was seen 10 s after the start, 5 m ahead, and is out of sight since.
class RememberedPlaces : public testing::Test {
 protected:
  RememberedPlaces() {
    planning::Column column;
    column.min_x_m = column.max_x_m = 5.0F;
    column.confirmed = true;
    column.seen = at(10.0);
    state_.obstacles.restore({column}, {});
  }
  static Stamp at(double seconds) { return stamp_from_seconds(seconds); }
  void localized(double seconds, const Transform2<Map, Odom>& map_from_odom) {
    state_.anchors.push_back({at(seconds), map_from_odom});
    state_.pose.map_from_base = map_from_odom * Transform2<Odom, Base>();
  }
  /// A sweep was measured then, while the odometry lay so.
  void sweep(double seconds, const Transform2<Map, Odom>& map_from_odom) {
    state_.pose.health.state = LocalizationState::Localized;
    state_.pose.map_from_base = map_from_odom * Transform2<Odom, Base>();
    note_anchor(state_, at(seconds));
  }
  /// The map around the vehicle has been moved so since the start, and the odometry so on it.
  void think(const Transform2<Map, Map>& moved, const Transform2<Map, Odom>& map_from_odom) {
    PoseEstimate pose = state_.pose;
    pose.moved = moved;
    pose.map_from_base = moved * map_from_odom * Transform2<Odom, Base>();
    take_pose(state_, pose);
  }
  Point2<Map> place() { return obstacle_points(state_, config_).front(); }

 private:
  CycleConfig config_ = test::toy_config({});
  CycleState state_{config_, nullptr};
};

TEST_F(RememberedPlaces, WhatIsOutOfSightStaysInItsPlaceWhenTheOdometryDrifts) {
  localized(9.9, {0.0, 0.0, 0.0});
  localized(10.4, {0.0, 0.0, 0.01});
  localized(60.0, {0.0, 0.0, 0.03});
  EXPECT_NEAR(place().x_m, 5.0, 1e-9);
  EXPECT_NEAR(place().y_m, 0.0, 1e-9) << "0.15 m beside it, were it where the odometry has it now";
}

TEST_F(RememberedPlaces, WhatIsThoughtBetterOfTheMapMovesItAlong) {
  sweep(9.9, {0.0, 0.0, 0.0});
  sweep(10.4, {0.0, 0.0, 0.0});
  think({0.1, 0.2, 0.05}, {0.0, 0.0, 0.0});
  EXPECT_NEAR(place().x_m, 0.1 + 5.0 * std::cos(0.05), 1e-9);
  EXPECT_NEAR(place().y_m, 0.2 + 5.0 * std::sin(0.05), 1e-9);
  think({0.1, 0.2, 0.05}, {0.0, 0.1, 0.0});  // the odometry drifts: nothing new is thought
  EXPECT_NEAR(place().y_m, 0.2 + 5.0 * std::sin(0.05), 1e-9);
  think({0.3, 0.2, 0.0}, {0.0, 0.1, 0.0});
  EXPECT_NEAR(place().x_m, 5.3, 1e-9);
  EXPECT_NEAR(place().y_m, 0.2, 1e-9);
}

TEST_F(RememberedPlaces, WhoWasElsewhereThanHeBelievedRemembersWhereHeDroveSince) {
  localized(9.9, {3.0, 0.0, 0.0});
  localized(60.0, {0.0, 0.0, 0.0});
  EXPECT_NEAR(place().x_m, 5.0, 1e-9);
}

TEST_F(RememberedPlaces, WithoutAnAnchorTheOdometryTells) {
  EXPECT_NEAR(place().x_m, 5.0, 1e-9);
  localized(60.0, {0.0, 1.0, 0.0});
  EXPECT_NEAR(place().y_m, 1.0, 1e-9);
}

TEST_F(RememberedPlaces, TwoLidarsWhoseSweepsComeInAnotherOrderThanTheyWereMeasuredForgetNothing) {
  sweep(9.9, {0.0, 0.0, 0.0});
  for (int i = 0; i < 40; ++i) {
    sweep(10.4 + 0.5 * i, {0.0, 0.0, 0.001 * i});
    sweep(10.37 + 0.5 * i, {0.0, 0.0, 0.001 * i});
  }
  EXPECT_NEAR(place().y_m, 0.0, 1e-9);
}

TEST_F(RememberedPlaces, WhenTheClockIsSetBackTheOdometryTells) {
  sweep(9.9, {0.0, 0.0, 0.0});
  sweep(20.0, {0.0, 0.1, 0.0});
  sweep(5.0, {0.0, 0.2, 0.0});
  EXPECT_NEAR(place().y_m, 0.2, 1e-9);
}

}  // namespace
}  // namespace madori::app
