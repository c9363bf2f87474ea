#include "app/cycle/site_in_building.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace madori::app {
namespace {

const mapping::Walls kWalls{{1, {{0.0, 0.0}, {20.0, 0.0}}}, {2, {{0.0, 4.0}, {20.0, 4.0}}}};

SiteInBuilding as_drawn() {
  std::vector<planning::RouteNode> nodes(3);
  for (int i = 0; i < 3; ++i) {
    nodes[static_cast<std::size_t>(i)].id = i + 1;
    nodes[static_cast<std::size_t>(i)].position = {2.0 + 8.0 * i, 2.0};
  }
  nodes[2].heading_rad = 0.25;
  std::vector<Segment2<Map>> segments;
  for (const auto& wall : kWalls) segments.push_back(wall.segment);
  return {planning::RouteGraph(nodes, {{0, 1, 0.0, 1}, {1, 2, 0.0, 2}}),
          std::make_shared<const planning::WallGrid>(segments)};
}

/// The building is 1 % larger than drawn, turned by a degree and 0.3 m to the side.
std::shared_ptr<const localization::BentDrawing> bent(double x_m = 0.3) {
  localization::WarpFit fit;
  fit.warp = localization::DrawingWarp({1.01, to_rad(1.0), x_m, -0.1}, {}, {});
  fit.walls.resize(kWalls.size());
  return std::make_shared<const localization::BentDrawing>(
      localization::BentDrawing{fit, localization::walls_in_building(kWalls, fit), {}});
}

TEST(SiteInBuilding, IsAsDrawnToTheBitUntilSomethingElseIsBelieved) {
  const SiteInBuilding site = as_drawn();
  const Transform2<Map, Base> pose(3.21, 1.23, 0.5);
  EXPECT_EQ(site.on_drawing(pose).x_m(), pose.x_m());
  EXPECT_EQ(site.in_building(pose).yaw_rad(), pose.yaw_rad());
  EXPECT_FALSE(site.differs(nullptr));
  const SiteInBuilding back = site.carried(bent()).carried(nullptr);
  EXPECT_EQ(back.routes().nodes()[1].position, site.routes().nodes()[1].position);
  EXPECT_EQ(back.walls(), site.walls());
}

TEST(SiteInBuilding, NodesHeadingsAndWallsStandWhereTheWarpCarriesThem) {
  const auto believed = bent();
  const SiteInBuilding site = as_drawn().carried(believed);
  const auto& node = site.routes().nodes()[2];
  const auto there = believed->fit.warp.building(Point2<Map>{18.0, 2.0});
  EXPECT_NEAR(node.position.x_m, there.x_m, 1e-9);
  EXPECT_NEAR(node.position.y_m, there.y_m, 1e-9);
  EXPECT_NEAR(*node.heading_rad, 0.25 + to_rad(1.0), 1e-9);
  EXPECT_GT(site.routes().legs()[0].length_m, 8.05);  // lengths are of the building
  const auto wall = believed->fit.warp.building(Point2<Map>{0.0, 4.0});
  EXPECT_NEAR(site.walls()->walls()[1].a.x_m, wall.x_m, 1e-9);
}

TEST(SiteInBuilding, WhatPeopleSeeIsOnTheDrawing) {
  const SiteInBuilding site = as_drawn().carried(bent());
  for (double x = 0.0; x < 20.0; x += 2.5) {
    const Transform2<Map, Base> drawn(x, 1.0, 0.1 * x - 1.0);
    const auto back = site.on_drawing(site.in_building(drawn));
    EXPECT_LT(distance_m(back.translation(), drawn.translation()), 2e-4);
    EXPECT_NEAR(back.yaw_rad(), drawn.yaw_rad(), 1e-6);
  }
}

TEST(SiteInBuilding, APathStaysOnTheDrawingWhereItWas) {
  const SiteInBuilding before = as_drawn().carried(bent(0.3));
  const SiteInBuilding after = before.carried(bent(0.8));
  EXPECT_TRUE(before.differs(after.bent()));
  EXPECT_FALSE(before.differs(bent(0.301)));  // less than a path is followed to
  Path path;
  for (int i = 0; i <= 10; ++i)
    path.points.push_back({before.in_building({2.0 + i, 2.0, 0.0}).translation(), to_rad(1.0), 0.0});
  const Path moved = before.carry_to(after, path);
  for (std::size_t i = 0; i < path.points.size(); ++i)
    EXPECT_LT(distance_m(after.on_drawing(moved.points[i].position), {2.0 + static_cast<double>(i), 2.0}),
              2e-4);
}

TEST(SiteInBuilding, APathEndsAtItsStationWhereverThatIsThought) {
  std::vector<planning::RouteNode> nodes(2);
  nodes[1].id = 1, nodes[1].position = {18.0, 3.0}, nodes[1].station = true;
  nodes[0].position = {2.0, 3.0};
  const SiteInBuilding drawn(planning::RouteGraph(nodes, {{0, 1, 0.0, 1}}), as_drawn().walls());
  localization::WarpFit fit;
  fit.walls.resize(kWalls.size());
  const auto site = drawn.carried(std::make_shared<const localization::BentDrawing>(localization::BentDrawing{
      fit, localization::walls_in_building(kWalls, fit), {{{18.0, 3.0}, {18.1, 2.6}}}}));
  EXPECT_TRUE(drawn.differs(site.bent()));
  const Point2<Map> station = site.routes().nodes()[1].position;
  EXPECT_EQ(station.y_m, 2.6);
  Path path;
  for (int i = 0; i <= 160; ++i) path.points.push_back({{2.0 + 0.1 * i, 3.0}, 0.0, 0.0});
  const Path led = drawn.carry_to(site, path);
  EXPECT_LT(distance_m(led.points.back().position, station), 1e-9);
  for (std::size_t i = 0; i < 125; ++i) EXPECT_EQ(led.points[i].position.y_m, 3.0);
  for (std::size_t i = 1; i < led.points.size(); ++i) {
    const Point2<Map>& a = led.points[i - 1].position;
    const Point2<Map>& b = led.points[i].position;
    EXPECT_NEAR(led.points[i - 1].heading_rad, std::atan2(b.y_m - a.y_m, b.x_m - a.x_m), 0.02);
    EXPECT_LT(std::abs(led.points[i].heading_rad), 0.25);
  }
}

}  // namespace
}  // namespace madori::app
