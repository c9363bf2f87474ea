#include "localization/wall_tracker/nearby_rival.hpp"

#include <gtest/gtest.h>

#include "localization/wall_extraction/wall_extraction.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/made_up_drive.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

/// The hall, in which the robot cell and the machine have been moved.
mapping::Walls rearranged(double dx_m) {
  mapping::Walls building = test::laboratory_hall();
  for (mapping::Wall& wall : building)
    for (Point2<Map>* p : {&wall.segment.a, &wall.segment.b})
      if ((wall.id >= 14 && wall.id < 18) || (wall.id >= 22 && wall.id < 26)) p->x_m += dx_m;
  return building;
}

struct End {
  double error_m = 0.0;
  int asides = 0;
};

/// Registration from scan to scan, begun `aside_m` beside the truth, with the rival asked each time.
End follow(const mapping::Walls& drawing, const mapping::Walls& building, double aside_m, bool asked = true) {
  std::mt19937 engine(5);
  const auto moments =
      test::drive(building, {{10.5, 5.5}, {10.5, 7.5}, {14.0, 7.5}, {14.0, 3.5}}, test::ten_hertz(), engine);
  const SegmentGrid grid(drawing);
  NearbyRival nearby;
  const SegmentIcpOptions near = {.first_scale_m = 0.25};
  Pose pose(moments[0].truth.x_m() + aside_m, moments[0].truth.y_m(), moments[0].truth.yaw_rad());
  if (asked) nearby.reopen();
  End end;
  for (std::size_t i = 1; i < moments.size(); ++i) {
    const auto motion = moments[i - 1].odometry.odom_from_base.inverse() * moments[i].odometry.odom_from_base;
    const ScanPoints points = extract_walls(moments[i].scan, {});
    pose = segment_icp(points, grid, pose * motion, near).map_from_base;
    if (const auto there = nearby.observe(points, grid, pose, motion)) {
      pose = there->map_from_base;
      ++end.asides;
    }
  }
  end.error_m = distance_m(pose.translation(), moments.back().truth.translation());
  return end;
}

TEST(NearbyRival, LeavesTheVehicleWhereAllIsAsDrawn) {
  const End end = follow(test::laboratory_hall(), test::laboratory_hall(), 0.0);
  EXPECT_LT(end.error_m, 0.02);
  EXPECT_EQ(end.asides, 0);
}

TEST(NearbyRival, LeavesTheVehicleWhereMachinesWereMoved) {
  for (const double dx_m : {-0.4, -0.25, 0.25, 0.4}) {
    const End end = follow(test::laboratory_hall(), rearranged(dx_m), 0.0);
    EXPECT_LT(end.error_m, 0.03) << dx_m;
    EXPECT_EQ(end.asides, 0) << dx_m;
  }
}

TEST(NearbyRival, PutsItRightWhereItWasFoundByWhatWasMoved) {
  for (const double dx_m : {-0.4, 0.4}) {
    const mapping::Walls hall = test::laboratory_hall();
    EXPECT_GT(follow(hall, rearranged(dx_m), -dx_m, false).error_m, 0.2) << dx_m;
    const End end = follow(hall, rearranged(dx_m), -dx_m);
    EXPECT_LT(end.error_m, 0.03) << dx_m;
    EXPECT_EQ(end.asides, 1) << dx_m;
  }
}

TEST(NearbyRival, BeginsAtTheBestPlaceBeside) {
  const mapping::Walls hall = test::laboratory_hall();
  const SegmentGrid grid(hall);
  std::mt19937 engine(6);
  const Pose truth(7.0, 2.0, 0.4);
  const ScanPoints points =
      extract_walls(test::simulate_scan(hall, truth, test::ten_hertz().lidar, engine), {});
  const RegistrationResult aside = segment_fit(points, grid, {7.4, 1.8, 0.4});
  NearbyRival nearby;
  EXPECT_TRUE(nearby.rests());
  const RegistrationResult begun = nearby.begin(points, grid, aside);
  EXPECT_LT(distance_m(begun.map_from_base.translation(), truth.translation()), 0.03);
  EXPECT_FALSE(nearby.rests());
}

}  // namespace
}  // namespace madori::localization
