#include "localization/drawing_fit/wall_lines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "localization/drawing_fit/standing.hpp"
#include "localization/scan_points.hpp"
#include "tests/support/made_up_buildings.hpp"

namespace madori::localization {
namespace {

/// Adds a keyframe that sees the walls.
void look_around(Memory& memory, const mapping::Walls& walls, const Transform2<Map, Base>& pose,
                 std::mt19937& engine) {
  test::ScanSettings settings = test::full_turn(720, 30.0);
  settings.range_sigma_m = 0.01;
  const ScanPoints seen = scan_points(test::simulate_scan(walls, pose, settings, engine), {});
  std::vector<Point2<Base>> points;
  for (std::size_t i = 0; i < seen.size(); ++i) points.push_back(seen.point(i));
  memory.add(make_surface_scan({}, {}, points), 1.0, pose, Eigen::Matrix3d::Identity());
}

/// The hall as some keyframes along its aisles saw it.
Memory walked_through(const mapping::Walls& walls) {
  std::mt19937 engine(6);
  Memory memory;
  const auto stop = [&](double x, double y) { look_around(memory, walls, {x, y, 0.1 * x}, engine); };
  for (double x = 2.0; x < 18.0; x += 1.0) stop(x, 1.2);
  for (double x = 6.5; x < 14.0; x += 1.0) stop(x, 7.6);
  for (double y = 1.2; y < 8.0; y += 1.0) stop(14.4, y);
  return memory;
}

/// Distance of a point to the nearest of the walls.
double off(const Point2<Map>& p, const mapping::Walls& walls) {
  double best = 1e9;
  for (const mapping::Wall& wall : walls) {
    const Segment2<Map>& s = wall.segment;
    const double length = s.length_m();
    const double ux = (s.b.x_m - s.a.x_m) / length;
    const double uy = (s.b.y_m - s.a.y_m) / length;
    const double t = std::clamp((p.x_m - s.a.x_m) * ux + (p.y_m - s.a.y_m) * uy, 0.0, length);
    best = std::min(best, distance_m(p, Point2<Map>{s.a.x_m + t * ux, s.a.y_m + t * uy}));
  }
  return best;
}

TEST(WallLines, LieOnTheWallsAndCoverTheLongOnes) {
  const mapping::Walls truth = test::laboratory_hall();
  const mapping::Walls found = wall_lines(memory_cloud(walked_through(truth)));
  ASSERT_FALSE(found.empty());
  for (const mapping::Wall& wall : found) {
    EXPECT_LT(off(wall.segment.a, truth), 0.1);
    EXPECT_LT(off(wall.segment.b, truth), 0.1);
  }
  // The outer walls that stand in sight of the aisles.
  for (const std::size_t i : {0, 5, 6}) {
    const Segment2<Map>& s = truth[i].segment;
    int covered = 0;
    for (int k = 1; k < 20; ++k) {
      const double f = k / 20.0;
      covered +=
          off({s.a.x_m + f * (s.b.x_m - s.a.x_m), s.a.y_m + f * (s.b.y_m - s.a.y_m)}, found) < 0.1 ? 1 : 0;
    }
    EXPECT_GE(covered, 15) << "wall " << i;
  }
}

/// A room through which one drives along x; a board stands in it as long as the vehicle is before `gone_x_m`.
class BoardInARoom : public testing::Test {
 protected:
  BoardInARoom() { test::add_box(room_, 0.0, 0.0, 12.0, 8.0); }
  void drive(double gone_x_m, int turns_a_stop) {
    mapping::Walls with_board = room_;
    test::add_wall(with_board, 4.0, 5.0, 6.0, 5.0);
    for (double x = 2.0; x < 10.0; x += 0.5)
      for (int turn = 0; turn < (x < gone_x_m ? turns_a_stop : 1); ++turn)
        look_around(memory_, x < gone_x_m ? with_board : room_, {x, 2.0, 0.3 * turn}, engine_);
  }
  /// Probability of the wall that was found where the board stood; 0: none was.
  [[nodiscard]] double board() const {
    for (const mapping::Wall& wall : wall_lines(standing_cloud(memory_)))
      if (off({5.0, 5.0}, {wall}) < 0.1) return wall.probability;
    return 0.0;
  }
  /// Walls of the room that were found, longer than four metres, certain.
  [[nodiscard]] long room_walls() const {
    const auto walls = wall_lines(standing_cloud(memory_));
    return std::count_if(walls.begin(), walls.end(), [&](const mapping::Wall& wall) {
      return wall.segment.length_m() > 4.0 && wall.probability > 0.99 && off(wall.segment.a, room_) < 0.1 &&
             off(wall.segment.b, room_) < 0.1;
    });
  }

  mapping::Walls room_;
  Memory memory_;
  std::mt19937 engine_{11};
};

TEST_F(BoardInARoom, IsAWallWhereItStands) {
  drive(10.0, 1);
  EXPECT_GT(board(), 0.95);
  EXPECT_EQ(room_walls(), 4);
}

TEST_F(BoardInARoom, IsNoneWhereItWasLookedThroughLater) {
  drive(4.2, 1);
  EXPECT_EQ(board(), 0.0);
  EXPECT_EQ(room_walls(), 4);
}

TEST_F(BoardInARoom, LooksFromOneStopAreOneLook) {
  drive(4.2, 20);  // a hundred looks at it, a dozen through where it was
  EXPECT_EQ(board(), 0.0);
  EXPECT_EQ(room_walls(), 4);
}

TEST_F(BoardInARoom, IsUncertainWhereItStoodMostOfTheTime) {
  drive(7.6, 1);
  EXPECT_GT(board(), 0.5);
  EXPECT_LT(board(), 0.9);
}

TEST(WallLines, WhatOneKeyframeSawIsNoWall) {
  Memory memory;
  SurfaceScan scan;
  for (int i = 0; i < 50; ++i) scan.points.push_back({2.0, -2.0 + 0.08 * i, -1.0, 0.0});
  memory.add(scan, 0.0, {}, Eigen::Matrix3d::Identity());
  EXPECT_TRUE(wall_lines(memory_cloud(memory)).empty());
  memory.add(scan, 0.0, {}, Eigen::Matrix3d::Identity());
  const mapping::Walls walls = wall_lines(memory_cloud(memory));
  ASSERT_EQ(walls.size(), 1u);
  EXPECT_NEAR(walls[0].segment.length_m(), 3.9, 0.25);
}

}  // namespace
}  // namespace madori::localization
