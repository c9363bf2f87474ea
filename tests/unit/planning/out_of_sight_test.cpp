#include "planning/obstacle_check/out_of_sight.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/angle.hpp"
#include "tests/support/toy_lidar.hpp"

namespace madori::planning {
namespace {

/// A person of 1.75 m is over-looked within 1.68 m of it.
LidarModel mast() {
  LidarModel lidar{};
  lidar.kind = LidarKind::Spinning;
  lidar.mounting.z_m = 2.2;
  lidar.min_elevation_rad = to_rad(-15.0);
  lidar.max_elevation_rad = to_rad(15.0);
  lidar.from_rad = -kPi;
  lidar.to_rad = kPi;
  return lidar;
}

/// A standing vehicle with a lidar on a mast, and one person.
struct Scene {
  std::vector<LidarModel> lidars{mast()};
  test::ToyLidar lidar;
  ObstacleField field{[] {
    FieldOptions options;
    options.top_m = 2.3;
    return options;
  }()};
  MovingObjects objects;
  OutOfSight out_of_sight;
  std::mt19937 random{3};
  double at_s = 0.0;

  Scene() {
    lidar.height_m = 2.2;
    lidar.posts.push_back({{3.5, 0.3}, 0.2, 1.75});
  }
  Point2<Map>& person() { return lidar.posts[0].at; }
  void look() {
    const Stamp stamp = stamp_from_seconds(at_s += 0.1);
    field.update(lidar.scan({}, stamp, random), SensorView::of(lidars[0]), {});
    objects.update(field.columns(), stamp);
    out_of_sight.update(objects, lidars, {}, stamp);
  }
  /// At 1 m/s.
  void walk_to(const Point2<Map>& goal) {
    for (double left = distance_m(person(), goal); left > 0.05; left = distance_m(person(), goal)) {
      const double share = std::min(1.0, 0.1 / left);
      person().x_m += share * (goal.x_m - person().x_m);
      person().y_m += share * (goal.y_m - person().y_m);
      look();
    }
  }
  void stand(double time_s) {
    for (double t = 0.0; t < time_s; t += 0.1) look();
  }
  [[nodiscard]] bool covers(const Point2<Map>& place) const {
    double nearest = 1e9;
    for (const auto& p : out_of_sight.points())
      nearest = std::min(nearest, std::hypot(p.x_m - place.x_m, p.y_m - place.y_m));
    return nearest < 0.4;
  }
};

TEST(OutOfSight, WhoWalksUnderTheMastIsBelievedThereUntilHeIsSeenToLeave) {
  Scene scene;
  scene.stand(1.0);
  scene.walk_to({0.9, 0.3});
  EXPECT_TRUE(scene.out_of_sight.anyone());
  EXPECT_TRUE(scene.covers(scene.person())) << "he walked on unseen";
  scene.stand(8.0);
  EXPECT_TRUE(scene.covers(scene.person())) << "and stood";
  scene.walk_to({-3.5, 0.3});
  EXPECT_FALSE(scene.out_of_sight.anyone()) << "seen to go on, behind the vehicle";
  EXPECT_TRUE(scene.out_of_sight.points().empty());
}

TEST(OutOfSight, WhoTurnsBackIsSeenToLeave) {
  Scene scene;
  scene.stand(1.0);
  scene.walk_to({1.0, 0.3});
  EXPECT_TRUE(scene.out_of_sight.anyone());
  scene.walk_to({3.5, 0.6});
  EXPECT_FALSE(scene.out_of_sight.anyone());
}

TEST(OutOfSight, WhoPassesInSightIsNeverOutOfIt) {
  Scene scene;
  scene.person() = {2.6, -3.0};
  scene.stand(1.0);
  scene.walk_to({2.6, 3.0});
  EXPECT_FALSE(scene.out_of_sight.anyone());
}

TEST(OutOfSight, AnotherLidarThatSeesHimThereKeepsHimInSight) {
  Scene scene;
  LidarModel low{};
  low.kind = LidarKind::Planar;
  low.mounting.z_m = 0.2;
  low.from_rad = -kPi;
  low.to_rad = kPi;
  scene.lidars.push_back(low);
  scene.stand(1.0);
  scene.walk_to({0.9, 0.3});
  EXPECT_FALSE(scene.out_of_sight.anyone());
}

/// Of whom a level lidar follows it knows no more than its own height: he is in sight wherever it looks.
TEST(OutOfSight, ALevelLidarLooksOverNobodyWhomItHasSeen) {
  LidarModel level{};
  level.kind = LidarKind::Planar;
  level.mounting.z_m = 0.25;
  level.from_rad = -kPi;
  level.to_rad = kPi;
  const std::vector<LidarModel> lidars{level};
  MovingObjects objects;
  OutOfSight out_of_sight;
  std::vector<Column> columns(1);
  for (int i = 0; i <= 20; ++i) {
    const Stamp stamp = stamp_from_seconds(0.1 * i);
    Column& leg = columns.front();
    leg.min_x_m = leg.max_x_m = 3.0F - 0.1F * static_cast<float>(i);
    leg.min_y_m = leg.max_y_m = 1.0F;
    leg.cell_x = 30 - i, leg.cell_y = 10;
    leg.low_m = leg.high_m = 0.25F;
    leg.confirmed = leg.entered = true;
    leg.seen = stamp;
    if (i == 20) columns.clear();  // he went behind something
    objects.update(columns, stamp);
    out_of_sight.update(objects, lidars, {}, stamp);
    EXPECT_FALSE(out_of_sight.anyone()) << i;
  }
  EXPECT_EQ(objects.lost().size(), 1U);
}

/// He is somewhere near for a while where the way he had is empty by now: the vehicle has gone on.
TEST(OutOfSight, WhoMayWalkBesideTheVehicleIsBelievedNearForAWhile) {
  Scene scene;
  scene.stand(1.0);
  scene.walk_to({1.2, 0.3});
  ASSERT_FALSE(scene.out_of_sight.points().empty());
  const MovingObjects nobody;
  const Transform2<Odom, Base> gone_on(-2.5, 0.0, 0.0);
  scene.out_of_sight.update(nobody, scene.lidars, gone_on, stamp_from_seconds(scene.at_s + 1.0));
  EXPECT_TRUE(scene.out_of_sight.points().empty());
  EXPECT_TRUE(scene.out_of_sight.anyone());
  scene.out_of_sight.update(nobody, scene.lidars, gone_on, stamp_from_seconds(scene.at_s + 20.0));
  EXPECT_FALSE(scene.out_of_sight.anyone());
}

/// His head comes and goes where the lowest laser passes just over it.
TEST(OutOfSight, WhoStandsAtTheRimIsBelievedThere) {
  Scene scene;
  scene.stand(1.0);
  scene.walk_to({1.55, 0.3});
  for (int i = 0; i < 20; ++i) {
    scene.person().x_m = i % 2 == 0 ? 1.7 : 1.55;
    scene.stand(0.3);
    EXPECT_TRUE(scene.out_of_sight.anyone()) << i;
  }
}

TEST(OutOfSight, WhoWasSeenAllAlongBesideTheMastIsAnotherOne) {
  Scene scene;
  scene.lidar.posts.push_back({{-2.4, -2.5}, 0.2, 1.75});
  scene.stand(1.0);
  for (int i = 0; i < 45; ++i) {
    if (i < 26) scene.person().x_m -= 0.1;
    scene.lidar.posts.back().at.y_m += 0.1;
    scene.look();
    EXPECT_TRUE(i < 30 || scene.out_of_sight.anyone()) << i;
  }
  scene.out_of_sight.clear();
  EXPECT_FALSE(scene.out_of_sight.anyone() || !scene.out_of_sight.points().empty());
}

}  // namespace
}  // namespace madori::planning
