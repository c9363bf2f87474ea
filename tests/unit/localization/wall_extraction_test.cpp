#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/segment_distance.hpp"
#include "localization/registration/segment_icp.hpp"
#include "localization/wall_extraction/wall_extractor.hpp"
#include "tests/support/lidar_models.hpp"
#include "tests/support/made_up_buildings.hpp"

namespace madori::localization {
namespace {

const LidarModel kLidar = test::spinning_lidar({0.0, 0.0, 1.2, 0.0});

using Pose = Transform2<Map, Base>;

/// A VLP-16-like revolution: walls up to the ceiling, or 5 m high without one, boxes of `low` with their own
/// height.
PointCloud<Base> revolution(const mapping::Walls& walls, const mapping::Walls& low, double low_height_m,
                            const Pose& pose, double sensor_height_m, std::mt19937& engine,
                            double ceiling_m = INFINITY) {
  std::normal_distribution<double> noise(0.0, 0.01);
  PointCloud<Base> cloud;
  for (int a = 0; a < 1800; ++a) {
    const double angle = a * 2.0 * kPi / 1800.0;
    const double wall = test::cast_ray(walls, pose.translation(), pose.yaw_rad() + angle);
    const double box = test::cast_ray(low, pose.translation(), pose.yaw_rad() + angle);
    for (int ring = 0; ring < 16; ++ring) {
      const double up = std::tan(to_rad(-15.0 + 2.0 * ring));
      const bool on_box = box < wall && sensor_height_m + box * up < low_height_m;
      const double ceiling = up > 0.0 ? (ceiling_m - sensor_height_m) / up : INFINITY;
      const double range = std::min(on_box ? box : wall, ceiling) + noise(engine);
      const double z = sensor_height_m + range * up;
      if (!(range < 100.0) || z < 0.0 || z > 5.0) continue;
      cloud.points.push_back({static_cast<float>(range * std::cos(angle)),
                              static_cast<float>(range * std::sin(angle)), static_cast<float>(z), 0.0F, 0,
                              static_cast<std::uint8_t>(ring)});
    }
  }
  return cloud;
}

bool is_off(const mapping::Walls& walls, const Point2<Map>& p) {
  return std::all_of(walls.begin(), walls.end(),
                     [&](const auto& wall) { return distance_m(wall.segment, p) > 0.15; });
}

class CloudWalls : public testing::Test {
 protected:
  std::mt19937 engine_{17};
  const mapping::Walls hall_ = [] {
    mapping::Walls walls;
    test::add_box(walls, 0.0, 0.0, 30.0, 18.0);
    test::add_wall(walls, 20.0, 0.0, 20.0, 7.0);
    return walls;
  }();
  const Pose pose_{8.0, 7.0, 0.4};
};

TEST_F(CloudWalls, LieOnTheWallsWithNormalsTowardsTheSensor) {
  const ScanPoints points = extract_walls(revolution(hall_, {}, 0.0, pose_, 1.2, engine_), kLidar);
  ASSERT_GT(points.size(), 300U);
  const SegmentGrid grid(hall_);
  const RegistrationResult fit = segment_fit(points, grid, pose_);
  EXPECT_GT(fit.inlier_fraction, 0.98);
  EXPECT_LT(fit.rmse_m, 0.03);
  int with_normal = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.normal_x[i] == 0.0F && points.normal_y[i] == 0.0F) continue;
    ++with_normal;
    EXPECT_LE(points.normal_x[i] * points.x_m[i] + points.normal_y[i] * points.y_m[i], 0.0F);
    EXPECT_NEAR(std::hypot(points.normal_x[i], points.normal_y[i]), 1.0, 1e-5);
  }
  EXPECT_GT(with_normal, 0.8 * static_cast<double>(points.size()));
}

TEST_F(CloudWalls, OneRevolutionLeavesNothingToTheNext) {
  mapping::Walls machines;
  test::add_box(machines, 3.0, 3.0, 6.5, 12.0);
  WallExtractor extractor;
  for (const double yaw_rad : {0.4, 2.0, -1.0}) {
    const Pose pose(8.0 + yaw_rad, 7.0, yaw_rad);
    const auto cloud =
        revolution(hall_, yaw_rad > 1.0 ? machines : mapping::Walls{}, 1.5, pose, 1.2, engine_);
    const ScanPoints alone = extract_walls(cloud, kLidar);
    const ScanPoints& among = extractor.extract(cloud, kLidar);
    EXPECT_EQ(among.x_m, alone.x_m);
    EXPECT_EQ(among.y_m, alone.y_m);
    EXPECT_EQ(among.weight, alone.weight);
    EXPECT_EQ(among.normal_x, alone.normal_x);
  }
  EXPECT_TRUE(extractor.extract({}, kLidar).empty());
}

TEST_F(CloudWalls, SeeOverMachinesAndThroughGaps) {
  mapping::Walls machines;  // 1.5 m high on three sides, the lidar looks over them
  test::add_box(machines, 3.0, 3.0, 6.5, 12.0);
  test::add_box(machines, 9.5, 3.0, 14.0, 12.0);
  const ScanPoints points = extract_walls(revolution(hall_, machines, 1.5, pose_, 1.2, engine_), kLidar);
  const RegistrationResult fit = segment_fit(points, SegmentGrid(hall_), pose_);
  EXPECT_GT(fit.inlier_fraction, 0.9);
  int behind = 0;  // points on the hall's own walls that a 2D lidar would not see
  for (std::size_t i = 0; i < points.size(); ++i) behind += (pose_ * points.point(i)).x_m < 0.1;
  EXPECT_GT(behind, 30);
}

TEST_F(CloudWalls, LeaveOutWhatIsNotAsTallAsItCouldBe) {
  mapping::Walls people;  // 1.8 m tall, 2 m away: the upper lasers pass above
  test::add_box(people, 10.0, 7.5, 10.4, 7.9);
  test::add_box(people, 6.0, 6.0, 6.4, 6.4);
  const ScanPoints points = extract_walls(revolution(hall_, people, 1.25, pose_, 1.2, engine_), kLidar);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_GT(distance_m(pose_ * points.point(i), pose_.translation()), 4.0);
}

TEST(CloudWallsUnderACeiling, TheCeilingSeenPastADoorIsNoWall) {
  mapping::Walls rooms;  // with a door of two metres between them; the lidar sits before the wheels' middle
  test::add_box(rooms, 0.0, 0.0, 12.0, 8.0);
  test::add_box(rooms, 7.0, 0.0, 7.2, 3.0);
  test::add_box(rooms, 7.0, 5.0, 7.2, 8.0);
  const LidarMounting mounting{0.3, 0.0, 1.2, 0.0};
  const LidarModel lidar = test::spinning_lidar(mounting);
  std::mt19937 engine(23);
  for (int turn = 0; turn < 24; ++turn) {
    const Pose pose(9.0 + 0.02 * turn, 1.6 + 0.2 * turn, 2.0 * kPi * turn / 24);
    const Pose sensor = pose * Transform2<Base, Base>(mounting.x_m, mounting.y_m, 0.0);
    PointCloud<Base> cloud = revolution(rooms, {}, 0.0, sensor, 1.2, engine, 3.0);
    for (CloudPoint& p : cloud.points) p.x_m += static_cast<float>(mounting.x_m);
    const ScanPoints points = extract_walls(cloud, lidar);
    ASSERT_GT(points.size(), 100U);
    int off = 0;
    for (std::size_t i = 0; i < points.size(); ++i) off += is_off(rooms, pose * points.point(i)) ? 1 : 0;
    EXPECT_LE(off, 0.02 * static_cast<double>(points.size())) << turn;  // at the jambs, within a sector
  }
}

TEST_F(CloudWalls, NothingInNothingOut) {
  EXPECT_TRUE(extract_walls(PointCloud<Base>{}, kLidar).empty());
}

TEST(ScanWalls, LongLinesCountAndLegsDoNot) {
  mapping::Walls walls;
  test::add_box(walls, 0.0, 0.0, 12.0, 8.0);
  mapping::Walls with_legs = walls;
  test::add_box(with_legs, 6.0, 3.0, 6.12, 3.12);
  test::add_box(with_legs, 6.3, 3.1, 6.42, 3.22);
  std::mt19937 engine(8);
  const Pose pose(3.0, 3.0, 0.0);
  test::ScanSettings settings;
  settings.range_sigma_m = 0.008;
  const ScanPoints points = extract_walls(test::simulate_scan(with_legs, pose, settings, engine), {});
  const SegmentGrid grid(walls);
  double on_wall = 0.0, legs = 0.0;
  int walls_seen = 0, legs_seen = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point2<Map> p = pose * points.point(i);
    const bool leg = std::abs(p.x_m - 6.2) < 0.4 && std::abs(p.y_m - 3.1) < 0.3;
    (leg ? legs : on_wall) += points.weight[i];
    ++(leg ? legs_seen : walls_seen);
    if (leg || points.normal_x[i] == 0.0F) continue;
    EXPECT_GT(std::max(std::abs(points.normal_x[i]), std::abs(points.normal_y[i])), 0.9);
  }
  ASSERT_GT(legs_seen, 3);
  EXPECT_GT(on_wall / walls_seen, 0.9);
  EXPECT_LT(legs / legs_seen, 0.35);
  EXPECT_GT(segment_fit(points, grid, pose).inlier_fraction, 0.99);
}

}  // namespace
}  // namespace madori::localization
