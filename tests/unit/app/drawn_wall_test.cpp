#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/route_graph/route_csv.hpp"
#include "tests/support/toy_vehicle.hpp"

namespace madori::app {
namespace {

using test::ToyVehicle;

/// A straight way of 8 m past a wall that is drawn along the vehicle's right side, `inside_m` within its
/// outline, where nothing stands.
std::unique_ptr<ToyVehicle> beside_wall(double inside_m) {
  auto config =
      test::toy_config(planning::parse_routes("ID,EDA\n0,1\n1,0\n", "ID,x,y\n0,0,0\n1,8,0\n").graph);
  const double y_m = -config.check.vehicle.half_width_m + inside_m;
  const std::vector<Segment2<Map>> walls{{{-0.5, y_m}, {0.4, y_m}}};
  config.walls = std::make_shared<planning::WallGrid>(walls);
  return std::make_unique<ToyVehicle>(config, Transform2<Map, Base>(0.0, 0.0, 0.0));
}

TEST(DrawnWall, OneThatReachesALittleIntoTheVehicleDoesNotHoldIt) {
  for (const double inside_m : {0.01, 0.04, 0.08}) {
    auto v = beside_wall(inside_m);
    v->drive_to({{1}});
    v->say(OperatorWord::Resume);
    EXPECT_FALSE(v->run_until([&] { return v->rolling.pose().x_m() > 0.05; }, 5.0)) << "not at once";
    EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0)) << inside_m;
    EXPECT_EQ(v->state().block.squeeze.wall_slack_m, 0.0) << "elsewhere walls count whole";
  }
}

TEST(DrawnWall, OneThatReachesDeepIntoTheVehicleHoldsIt) {
  auto v = beside_wall(0.2);
  v->drive_to({{1}});
  v->say(OperatorWord::Resume);
  EXPECT_FALSE(v->run_until([&] { return std::abs(v->rolling.pose().x_m()) > 0.05; }, 60.0));
  EXPECT_EQ(v->state().mode, Mode::Waiting);
}

}  // namespace
}  // namespace madori::app
