#include "planning/obstacle_check/obstacle_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "core/angle.hpp"
#include "tests/support/toy_lidar.hpp"

namespace madori::planning {
namespace {

using test::kVlp;

Stamp at(double seconds) {
  return stamp_from_seconds(seconds);
}

int confirmed(const ObstacleField& field) {
  int count = 0;
  for (const Column& column : field.columns()) count += column.confirmed ? 1 : 0;
  return count;
}

TEST(GroundPlane, FindsATiltedFloorAmongObstacles) {
  std::mt19937 random(1);
  test::ToyLidar lidar;
  for (int i = 0; i < 10; ++i) lidar.posts.push_back({{3.0 + 0.2 * i, 0.1 * i}, 0.1, 1.5});
  PointCloud<Base> cloud = lidar.scan({}, at(0), random);
  for (auto& p : cloud.points) p.z_m += 0.02F * p.x_m - 0.01F;
  const GroundPlane plane = fit_ground(cloud.points);
  EXPECT_GT(plane.points, 1000);
  EXPECT_NEAR(plane.slope_x, 0.02, 0.002);
  EXPECT_NEAR(plane.offset_m, -0.01, 0.005);
}

TEST(GroundPlane, WithoutAFloorTheWheelsPlaneStands) {
  EXPECT_EQ(fit_ground({}).points, 0);
  std::vector<CloudPoint> wall;
  for (int i = 0; i < 200; ++i) wall.push_back({2.0F, 0.02F * static_cast<float>(i), 0.05F, 0.0F, 1, 0});
  EXPECT_EQ(fit_ground(wall).points, 0);
}

TEST(ObstacleField, AnEmptyFloorHoldsNoObstacle) {
  std::mt19937 random(2);
  ObstacleField field;
  for (int i = 0; i < 20; ++i) field.update(test::ToyLidar().scan({}, at(0.1 * i), random), kVlp, {});
  EXPECT_EQ(confirmed(field), 0);
}

TEST(ObstacleField, APostIsSeenAtOnce) {
  std::mt19937 random(3);
  test::ToyLidar lidar;
  lidar.posts.push_back({{3.0, 0.0}});
  ObstacleField field;
  field.update(lidar.scan({}, at(0), random), kVlp, {});
  ASSERT_GT(confirmed(field), 0);
  EXPECT_NEAR(static_cast<double>(field.columns()[0].max_x_m), 3.0, 0.1);
}

TEST(ObstacleField, ASingleStrayPointIsNoObstacleButARepeatedOneIs) {
  ObstacleField field;
  PointCloud<Base> cloud{at(0), {{2.0F, 0.05F, 0.4F, 0.0F, 1, 5}}};
  field.update(cloud, kVlp, {});
  EXPECT_EQ(confirmed(field), 0);
  cloud.stamp = at(0.1);
  field.update(cloud, kVlp, {});
  EXPECT_EQ(confirmed(field), 1);
}

TEST(ObstacleField, WhatHangsHigherThanTheVehicleIsNoObstacle) {
  std::mt19937 random(4);
  test::ToyLidar lidar;
  lidar.posts.push_back({{3.0, 0.0}, 0.5, 2.5, 1.0});
  ObstacleField field;
  field.update(lidar.scan({}, at(0), random), kVlp, {});
  EXPECT_EQ(confirmed(field), 0);
  lidar.posts[0].bottom_m = 0.8;
  field.update(lidar.scan({}, at(0.1), random), kVlp, {});
  EXPECT_GT(confirmed(field), 0);
}

TEST(ObstacleField, ALowBodyIsRememberedInTheBlindZoneAndATallOneThatLeftIsNot) {
  std::mt19937 random(5);
  test::ToyLidar lidar;
  lidar.bodies.push_back({{{3.0, -0.3}, {3.0, 0.3}}});
  ObstacleField field;
  for (int i = 0; i <= 22; ++i) {
    const double x = 0.1 * i;
    field.update(lidar.scan({x, 0.0, 0.0}, at(0.1 * i), random), kVlp, {x, 0.0, 0.0});
  }
  EXPECT_GT(confirmed(field), 3) << "0.7 m before the vehicle, where no beam reaches it";
  const Transform2<Odom, Base> standing{2.2, 0.0, 0.0};
  for (int i = 23; i < 100; ++i)
    field.update(lidar.scan({2.2, 0.0, 0.0}, at(0.1 * i), random), kVlp, standing);
  EXPECT_GT(confirmed(field), 3) << "standing before it";

  field.forget_near({3.0, 0.0}, 1.0);
  EXPECT_EQ(confirmed(field), 0) << "the operator has looked at it";
  lidar.bodies.clear();
  lidar.posts.push_back({{3.3, 0.0}, 0.2, 1.7});
  for (int i = 100; i < 110; ++i)
    field.update(lidar.scan({2.2, 0.0, 0.0}, at(0.1 * i), random), kVlp, standing);
  EXPECT_GT(confirmed(field), 0);
  lidar.posts.clear();
  for (int i = 110; i < 125; ++i)
    field.update(lidar.scan({2.2, 0.0, 0.0}, at(0.1 * i), random), kVlp, standing);
  EXPECT_EQ(confirmed(field), 0) << "a person who has left";
}

TEST(ObstacleField, APalletAsHighAsTheVehicleIsRememberedBeforeTheBumper) {
  std::mt19937 random(7);
  test::ToyLidar lidar;
  lidar.height_m = 1.2;
  lidar.bodies.push_back({{{3.0, -0.5}, {3.0, 0.5}}, 0.4, 0.85});
  const SensorView view{0.0, 0.0, 1.2, to_rad(-15.0), to_rad(15.0)};
  ObstacleField field;
  double x = 0.0;
  for (int i = 0; i < 200; ++i) {
    if (x < 1.9) x += 0.05;
    field.update(lidar.scan({x, 0.0, 0.0}, at(0.1 * i), random), view, {x, 0.0, 0.0});
  }
  int before = 0;
  for (const Column& c : field.columns())
    before += c.confirmed && static_cast<double>(c.max_x_m) < 2.8 ? 1 : 0;
  EXPECT_GT(before, 5) << "its face 0.7 m before the lidar, where no beam reaches lower than 1.0 m";
}

TEST(ObstacleField, APersonWhoStandsBeforeTheBumperIsNotForgotten) {
  std::mt19937 random(6);
  test::ToyLidar lidar;
  lidar.height_m = 1.2;
  lidar.posts.push_back({{2.4, 0.0}, 0.2, 1.75});
  const SensorView view{0.0, 0.0, 1.2, to_rad(-15.0), to_rad(15.0)};
  ObstacleField field;
  for (int i = 0; i < 100; ++i) {
    if (lidar.posts[0].at.x_m > 0.8) lidar.posts[0].at.x_m -= 0.1;
    field.update(lidar.scan({}, at(0.1 * i), random), view, {});
  }
  EXPECT_GT(confirmed(field), 0) << "its legs are below the lowest beam";
  lidar.posts.clear();
  for (int i = 100; i < 115; ++i) field.update(lidar.scan({}, at(0.1 * i), random), view, {});
  EXPECT_EQ(confirmed(field), 0) << "and it has left";
}

/// A load that is passed closely: its face is below the lasers when somebody who stood before it goes away.
TEST(ObstacleField, WhoStoodBeforeAPalletDoesNotTakeItAlong) {
  std::mt19937 random(7);
  test::ToyLidar lidar;
  lidar.height_m = 1.2;
  lidar.bodies.push_back({{{2.0, 0.9}, {2.8, 0.9}}, 0.4, 0.9});
  FieldOptions options;
  options.top_m = 1.3;
  ObstacleField field(options);
  const SensorView view{0.0, 0.0, 1.2, to_rad(-15.0), to_rad(15.0)};
  double at_s = 0.0;
  const auto look = [&](double x_m) {
    field.update(lidar.scan({x_m, 0.0, 0.0}, at(at_s += 0.1), random), view, {x_m, 0.0, 0.0});
  };
  const auto face = [&] {
    return std::ranges::count_if(field.columns(), [](const Column& c) {
      return c.confirmed && c.min_y_m > 0.4F && c.min_y_m < 0.6F && c.min_x_m > 2.0F && c.max_x_m < 2.8F;
    });
  };
  for (double x_m = -1.5; x_m < 2.1; x_m += 0.05) look(x_m);
  const auto before = face();
  EXPECT_GT(before, 5);
  lidar.posts.push_back({{2.4, 0.33}, 0.12, 1.75});
  for (int i = 0; i < 20; ++i) look(2.1);
  lidar.posts.clear();
  for (int i = 0; i < 30; ++i) look(2.1);
  EXPECT_GE(face(), before - 1);
}

TEST(ObstacleField, OneGlimpseOfSomethingTallDoesNotHauntTheBlindZone) {
  const SensorView high{0.0, 0.0, 1.25, to_rad(-15.0), to_rad(15.0)};  // sees nothing below 0.8 m at 1.6 m
  for (const int scans : {1, 3}) {
    ObstacleField field;
    PointCloud<Base> cloud{at(0), {}};
    for (const float z : {0.56F, 0.64F, 0.72F}) cloud.points.push_back({1.62F, 0.05F, z, 0.0F, 1, 5});
    for (int i = 0; i < scans; ++i) {
      cloud.stamp = at(0.1 * i);
      field.update(cloud, high, {});
    }
    EXPECT_EQ(confirmed(field), 1);
    for (int i = 5; i < 30; ++i) field.update({at(0.1 * i), {}}, high, {});
    EXPECT_EQ(confirmed(field), scans == 1 ? 0 : 1) << scans;
  }
}

/// The edge of a foot, seen once 4 m away; then he walks off, and the vehicle drives up to where he was.
TEST(ObstacleField, TheFootOfWhoCameAndLeftDoesNotHauntTheBlindZone) {
  std::mt19937 random(8);
  test::ToyLidar lidar;
  lidar.height_m = 1.2;
  const SensorView view{0.0, 0.0, 1.2, to_rad(-15.0), to_rad(15.0)};
  ObstacleField field;
  double at_s = 0.0;
  const auto look = [&](double x_m, bool foot) {
    auto scan = lidar.scan({x_m, 0.0, 0.0}, at(at_s += 0.1), random);
    if (foot) scan.points.push_back({static_cast<float>(3.9 - x_m), 0.22F, 0.09F, 0.0F, 1, 0});
    field.update(scan, view, {x_m, 0.0, 0.0});
  };
  for (int i = 0; i < 20; ++i) look(0.0, false);
  lidar.posts.push_back({{4.0, 0.0}, 0.2, 1.75});
  look(0.0, true);
  EXPECT_TRUE(
      std::ranges::any_of(field.columns(), [](const Column& c) { return c.confirmed && c.min_y_m > 0.2F; }));
  lidar.posts.clear();
  for (double x_m = 0.1; x_m < 3.0; x_m += 0.1) look(x_m, false);
  EXPECT_EQ(confirmed(field), 0);
}

/// The top of a load comes above the lowest beam and goes below it again while the vehicle drives past.
TEST(ObstacleField, ALoadThatTheVehicleDrivesPastDoesNotMove) {
  std::mt19937 random(9);
  test::ToyLidar lidar;
  lidar.height_m = 1.2;
  lidar.noise_m = 0.03;
  lidar.bodies.push_back({{{3.0, -0.9}, {4.0, -1.4}}, 0.4, 0.92});
  const SensorView view{0.0, 0.0, 1.2, to_rad(-15.0), to_rad(15.0)};
  FieldOptions options;
  options.top_m = 1.17;
  ObstacleField field(options);
  int entered = 0;
  for (int i = 0; i < 200; ++i) {
    const double x = 0.04 * i;
    field.update(lidar.scan({x, 0.0, 0.0}, at(0.1 * i), random), view, {x, 0.0, 0.0});
    for (const Column& c : field.columns()) entered += c.confirmed && c.entered;
  }
  EXPECT_EQ(entered, 0);
}

/// A wall 0.45 m to the right. Something short of it, which only the lowest beam grazes, shows for some
/// scans.
int confirmed_before_a_wall(float y_m, int points, int scans) {
  std::mt19937 random(10);
  test::ToyLidar lidar;
  lidar.height_m = 1.2;
  lidar.bodies.push_back({{{-2.0, -0.85}, {4.0, -0.85}}, 0.4, 2.5});
  const SensorView view{0.0, 0.0, 1.2, to_rad(-15.0), to_rad(15.0)};
  FieldOptions options;
  options.top_m = 1.3;
  ObstacleField field(options);
  int most = 0;
  for (int i = 0; i < 60; ++i) {
    auto scan = lidar.scan({}, at(0.1 * i), random);
    for (int k = 0; i >= 20 && i < 20 + scans && k < points; ++k)
      scan.points.push_back({0.64F + 0.01F * static_cast<float>(k), y_m, 1.02F, 0.0F, 1, 0});
    field.update(scan, view, {});
    const auto before = std::ranges::count_if(field.columns(), [](const Column& c) {
      return c.confirmed && c.min_x_m > 0.5F && c.max_y_m > -0.37F;
    });
    most = std::max(most, static_cast<int>(before));
    if (i == 59 && before > 0) return -1;  // it is still there
  }
  return most;
}

TEST(ObstacleField, AStrayPointIsNotConfirmedByTheWallBehindIt) {
  EXPECT_EQ(confirmed_before_a_wall(-0.34F, 1, 1), 0);
}

TEST(ObstacleField, WhoWentByBeforeAWallIsNotKeptByTheWall) {
  EXPECT_GT(confirmed_before_a_wall(-0.26F, 4, 3), 0);
}

/// The parts of a load's face that go on towards the lidar, while the vehicle drives up to it.
std::ptrdiff_t going_on(double face_x_m) {
  std::mt19937 random(11);
  test::ToyLidar lidar;
  lidar.height_m = 1.2;
  lidar.noise_m = 0.02;
  lidar.bodies.push_back({{{face_x_m + 0.4, 0.5}, {face_x_m + 0.4, 1.7}}, 0.4, 0.95});
  const SensorView view{0.0, 0.0, 1.2, to_rad(-15.0), to_rad(15.0)};
  FieldOptions options;
  options.top_m = 1.3;
  ObstacleField field(options);
  std::ptrdiff_t count = 0;
  for (int i = 0; i < 150; ++i) {
    const double x = std::min(0.04 * i, 3.3);
    field.update(lidar.scan({x, 0.0, 0.0}, at(0.1 * i), random), view, {x, 0.0, 0.0});
    count += std::ranges::count_if(field.columns(),
                                   [](const Column& c) { return c.confirmed && c.has_hidden_part(); });
  }
  return count;
}

/// It was seen down to the floor before the lidar came so near that it sees the upper edge only.
TEST(ObstacleField, ALoadThatTheVehicleDrivesUpToGoesOnNowhere) {
  for (const double face_x_m : {4.56, 4.58, 4.6, 4.62, 4.64}) EXPECT_EQ(going_on(face_x_m), 0) << face_x_m;
}

/// A mast of 2.2 m: the lowest beam passes over whatever stands near it.
class SeenFromAbove : public testing::Test {
 protected:
  /// Something at x = 1.8 m, from `low_m` to 1.72 m, and higher where `high_m` says so.
  void look(float low_m, float high_m = 0.0F, double odom_x_m = 0.0) {
    PointCloud<Base> cloud{at(at_s_ += 0.1), {}};
    const float x = 1.8F - static_cast<float>(odom_x_m);
    for (const float y : {0.02F, 0.04F, 0.06F}) {
      cloud.points.push_back({x, y, low_m, 0.0F, 1, 0});
      cloud.points.push_back({x, y, 1.72F, 0.0F, 1, 0});
      if (high_m > 0.0F) cloud.points.push_back({x, y, high_m, 0.0F, 1, 0});
    }
    if (low_m == 0.0F) cloud.points.clear();
    field_.update(cloud, {0.0, 0.0, 2.2, to_rad(-15.0), to_rad(15.0)}, {odom_x_m, 0.0, 0.0});
  }
  [[nodiscard]] bool goes_on() const {
    return std::ranges::any_of(field_.columns(), [](const Column& c) { return c.has_hidden_part(); });
  }

 private:
  static FieldOptions tall() {
    FieldOptions options;
    options.top_m = 2.3;
    return options;
  }
  ObstacleField field_{tall()};
  double at_s_ = 0.0;

 protected:
  [[nodiscard]] const ObstacleField& field() const { return field_; }
};

TEST_F(SeenFromAbove, WhoShowsHisFarSideOnlyGoesOnTowardsTheLidar) {
  for (int i = 0; i < 5; ++i) look(1.71F);
  ASSERT_TRUE(goes_on());
  const auto end = field().columns().front().hidden_at(field().options().hidden_m);
  EXPECT_NEAR(end.x_m, 1.8 - field().options().hidden_m, 0.02);
  EXPECT_NEAR(end.y_m, 0.04, 0.02);
  for (int i = 0; i < 20; ++i) look(0.0F, 0.0F, 0.9);
  EXPECT_TRUE(goes_on()) << "nearer still, nobody sees him";
  look(1.71F, 0.0F, -1.0);
  EXPECT_FALSE(goes_on()) << "from further away there is nothing before what was seen";
}

TEST_F(SeenFromAbove, WhatWasSeenFurtherDownEndsThere) {
  look(0.15F);
  EXPECT_FALSE(goes_on());
}

TEST_F(SeenFromAbove, AFaceIsNoRimOfAFarSide) {
  for (const float low_m : {1.63F, 1.65F}) {
    look(low_m);
    EXPECT_TRUE(goes_on()) << low_m;
  }
  look(1.58F);  // the lowest beam falls by 0.11 m across a person
  EXPECT_FALSE(goes_on());
}

TEST_F(SeenFromAbove, WhatReachesUpToTheLidarEndsThere) {
  look(1.71F, 2.2F);
  EXPECT_FALSE(goes_on());
}

TEST(ObstacleField, OneGlimpseOfAPersonWhoStaysCounts) {
  const SensorView high{0.0, 0.0, 1.25, to_rad(-15.0), to_rad(15.0)};
  ObstacleField field;
  PointCloud<Base> cloud{at(0), {}};
  for (const float z : {0.56F, 0.64F, 0.72F}) cloud.points.push_back({1.62F, 0.05F, z, 0.0F, 1, 5});
  field.update(cloud, high, {});
  cloud.points.clear();  // from now on only the upper part is in view
  for (const float z : {1.1F, 1.2F, 1.3F}) cloud.points.push_back({1.62F, 0.05F, z, 0.0F, 1, 5});
  for (int i = 1; i < 30; ++i) {
    cloud.stamp = at(0.1 * i);
    field.update(cloud, high, {});
  }
  EXPECT_EQ(confirmed(field), 1);
}

TEST(ObstacleField, WhatStandsAgainstTheSideIsThereThoughItsReturnsFallWithinTheOutline) {
  const SensorView lidar{0.3, 0.0, 1.2, to_rad(-15.0), to_rad(15.0)};
  const std::vector<Point2<Base>> post{{0.45, 0.295}, {0.46, 0.3}, {0.47, 0.305}};
  PointCloud<Base> scan{at(0.0), {}};
  for (const auto& p : post)
    scan.points.push_back({static_cast<float>(p.x_m), static_cast<float>(p.y_m) + 0.015F, 1.15F, 0.0F, 1, 0});
  FieldOptions options;
  options.top_m = 1.4;
  ObstacleField field(options);
  PointCloud<Base> nothing{at(0.1), {}};
  field.update(nothing, lidar, {}, post);
  EXPECT_TRUE(field.columns().empty()) << "the vehicle sees itself";
  scan.stamp = at(0.2);
  field.update(scan, lidar, {});
  ASSERT_EQ(confirmed(field), 1);
  const Column whole = field.columns().front();
  PointCloud<Base> part{at(0.3), {scan.points.back()}};
  field.update(part, lidar, {}, post);
  ASSERT_EQ(confirmed(field), 1);
  EXPECT_EQ(field.columns().front().min_y_m, whole.min_y_m);
  for (int i = 0; i < 20; ++i) {
    nothing.stamp = at(0.4 + 0.1 * i);
    field.update(nothing, lidar, {}, post);
  }
  EXPECT_EQ(confirmed(field), 1);
  EXPECT_EQ(field.columns().front().min_y_m, whole.min_y_m);
  for (int i = 0; i < 3; ++i) {  // neither beside it nor within it
    nothing.stamp = at(3.0 + 0.1 * i);
    field.update(nothing, lidar, {});
  }
  EXPECT_EQ(confirmed(field), 0);
}

TEST(ObstacleField, TheNearSideOfWhatTheLowestBeamBeginsToPassOverStaysWhereItWasSeen) {
  // Sees what is 1.2 m high from 0.37 m on, with its slack from 0.49 m.
  const SensorView lidar{0.3, 0.0, 1.3, to_rad(-15.0), to_rad(15.0)};
  FieldOptions options;
  options.top_m = 1.4;
  const auto box = [](double from_x_m, double to_x_m, double seconds) {
    PointCloud<Base> scan{at(seconds), {}};
    for (double x = from_x_m; x <= to_x_m; x += 0.01)
      for (const float z : {1.1F, 1.15F, 1.2F})
        scan.points.push_back({static_cast<float>(x), 0.55F, z, 0.0F, 1, 0});
    return scan;
  };
  ObstacleField field(options);
  field.update(box(0.31, 0.38, 0.0), lidar, {});
  field.update(box(0.31, 0.38, 0.1), lidar, {});
  ASSERT_EQ(confirmed(field), 1);
  for (int i = 2; i < 12; ++i) {  // aside, so that a stray point above it and its far end are all it shows
    PointCloud<Base> end = box(0.36, 0.38, 0.1 * i);
    end.points.push_back({0.37F, 0.55F, 1.35F, 0.0F, 1, 0});
    for (auto& p : end.points) p.y_m -= 0.12F;
    field.update(end, lidar, {0.0, 0.12, 0.0});
  }
  ASSERT_EQ(confirmed(field), 1);
  EXPECT_NEAR(field.columns().front().min_x_m, 0.31, 1e-6);
  EXPECT_NEAR(field.columns().front().top_m, 1.2, 1e-6);
}

TEST(ObstacleField, NonFinitePointsAreLeftOut) {
  ObstacleField field;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  PointCloud<Base> cloud{at(0), {}};
  for (int i = 0; i < 5; ++i) {
    cloud.points.push_back({nan, 1.0F, 0.4F, 0.0F, 1, 1});
    cloud.points.push_back({1.0F, inf, 0.4F, 0.0F, 1, 1});
    cloud.points.push_back({1.0F, 1.0F, nan, 0.0F, 1, 1});
  }
  field.update(cloud, kVlp, {});
  EXPECT_TRUE(field.columns().empty());
}

TEST(ObstacleField, WhatTheVehicleRanAgainstStandsWhereItWasFelt) {
  ObstacleField field;
  const std::vector<Point2<Odom>> places{{12.34, -7.61}, {12.38, -7.69}, {-3.02, 0.04}, {-3.02, 0.17}};
  for (int again = 0; again < 2; ++again) {
    field.add_felt(places, at(1));
    EXPECT_EQ(field.columns().size(), 3U) << "two of them in one square";
    EXPECT_TRUE(std::ranges::is_sorted(field.columns(), by_cell));
    for (const auto& place : places)
      EXPECT_TRUE(std::ranges::any_of(field.columns(), [&](const Column& c) {
        Column with = c;
        with.widen(place);
        return c.confirmed && with == c && c.cell_x == std::floor(10.0 * place.x_m) &&
               c.cell_y == std::floor(10.0 * place.y_m);
      })) << place.x_m;
  }
}

/// Beside a search through all points.
TEST(ColumnLayer, CountsWhatStandsBesideAndTellsHowHighItReaches) {
  struct Point {
    int x, y;
    double height_m;
    [[nodiscard]] bool beside(const Column& c, int cells) const {
      return std::abs(x - c.cell_x) <= cells && std::abs(y - c.cell_y) <= cells;
    }
  };
  constexpr double kCellM = 0.2, kTallM = 0.5;
  std::mt19937 random(8);
  std::uniform_real_distribution<double> height(0.1, 0.55), share(0.1, 0.9);
  for (int run = 0; run < 50; ++run) {
    const int mx = static_cast<int>(random() % 400) - 200, my = static_cast<int>(random() % 400) - 200;
    const auto points = [&](int count) {
      std::vector<Point> all;
      while (count-- > 0)
        all.push_back({mx + static_cast<int>(random() % 16) - 8, my + static_cast<int>(random() % 16) - 8,
                       height(random)});
      return all;
    };
    const auto laid = [&](ColumnLayer& layer, const std::vector<Point>& all) {
      layer.begin({(mx + 0.5) * kCellM, (my + 0.5) * kCellM}, 9.0 * kCellM, kCellM, at(1));
      for (const Point& p : all)
        layer.add({(p.x + share(random)) * kCellM, (p.y + share(random)) * kCellM}, p.height_m);
    };
    ColumnLayer layer, stood;
    const auto now = points(40), before = points(run % 2 == 0 ? 0 : 20);
    laid(layer, now);
    laid(stood, before);
    layer.confirm(3, kTallM, stood);
    const auto was = [&](int x, int y) {
      return std::ranges::any_of(before, [&](const Point& p) { return p.x == x && p.y == y; });
    };
    for (const Column& c : layer.columns()) {
      int count = 0;
      bool tall = false;
      std::vector<double> heights;
      for (const Point& p : now) {
        tall = tall || (p.beside(c, 3) && p.height_m > kTallM);
        if (!p.beside(c, 1)) continue;
        heights.push_back(p.height_m);
        if (was(c.cell_x, c.cell_y) || !was(p.x, p.y)) ++count;
      }
      std::ranges::sort(heights, std::greater());
      EXPECT_EQ(c.confirmed, count >= 3);
      EXPECT_EQ(c.part_of_tall, tall);
      EXPECT_NEAR(static_cast<double>(c.top_m), count > 1 ? heights[1] : static_cast<double>(c.high_m), 1e-6);
    }
  }
}

}  // namespace
}  // namespace madori::planning
