// A way that was driven by hand becomes nodes and legs.
#include "planning/route_graph/taught_route.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/angle.hpp"
#include "core/segment_distance.hpp"

namespace madori::planning {
namespace {

constexpr double kMps = 0.3;

/// Turns on the spot, then straight on, from place to place; `stops_s` how long it stands at each.
std::vector<DrivenPose> drive(const std::vector<Point2<Map>>& places, double stops_s = 0.0,
                              double noise_m = 0.0) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, noise_m > 0.0 ? noise_m : 1e-9);
  std::vector<DrivenPose> way;
  double time_s = 1000.0;
  const auto at = [&](double x_m, double y_m, double yaw_rad) {
    note_way(way, stamp_from_seconds(time_s), {x_m + noise(random), y_m + noise(random), yaw_rad});
  };
  for (std::size_t i = 1; i < places.size(); ++i) {
    const auto [a, b] = std::pair(places[i - 1], places[i]);
    const double yaw_rad = std::atan2(b.y_m - a.y_m, b.x_m - a.x_m);
    const double length = distance_m(a, b);
    for (double d = 0.0; d < length; d += 0.03, time_s += 0.03 / kMps)
      at(a.x_m + d / length * (b.x_m - a.x_m), a.y_m + d / length * (b.y_m - a.y_m), yaw_rad);
    at(b.x_m, b.y_m, yaw_rad);
    time_s += stops_s;
  }
  return way;
}

bool has_node_near(const RouteGraph& routes, const Point2<Map>& place, double within_m = 0.2) {
  return std::ranges::any_of(routes.nodes(),
                             [&](const auto& n) { return distance_m(n.position, place) < within_m; });
}

/// The farthest that a moment of the way lies from all legs.
double off_legs_m(const RouteGraph& routes, const std::vector<DrivenPose>& way) {
  double most_m = 0.0;
  for (const auto& moment : way) {
    double least_m = 1e9;
    for (const auto& leg : routes.legs())
      least_m = std::min(least_m, distance_m(Segment2<Map>{routes.nodes()[leg.from].position,
                                                           routes.nodes()[leg.to].position},
                                             moment.map_from_base.translation()));
    most_m = std::max(most_m, least_m);
  }
  return most_m;
}

TEST(TaughtRoute, AStraightWayIsOneLegBothWays) {
  const RouteGraph routes = taught({}, drive({{0, 0}, {8, 0}}, 0.0, 0.005));
  ASSERT_EQ(routes.nodes().size(), 2U);
  EXPECT_TRUE(routes.has_leg(0, 1));
  EXPECT_TRUE(routes.has_leg(1, 0));
}

TEST(TaughtRoute, CornersAndStopsGetNodes) {
  const auto way = drive({{0, 0}, {6, 0}, {6, 4}, {6, 7}}, 3.0);
  const RouteGraph routes = taught({}, way);
  for (const Point2<Map>& place : {Point2<Map>{0, 0}, {6, 0}, {6, 4}, {6, 7}})
    EXPECT_TRUE(has_node_near(routes, place));
  EXPECT_EQ(routes.nodes().size(), 4U);
  EXPECT_LT(off_legs_m(routes, way), 0.2);
}

TEST(TaughtRoute, ACurveStaysNearTheWay) {
  std::vector<DrivenPose> way;
  for (int i = 0; i <= 90; ++i) {
    const double a = to_rad(i);
    note_way(way, stamp_from_seconds(i * 0.1), {4.0 * std::sin(a), 4.0 - 4.0 * std::cos(a), a});
  }
  const RouteGraph routes = taught({}, way);
  EXPECT_GE(routes.nodes().size(), 3U);
  EXPECT_LE(routes.nodes().size(), 7U);
  EXPECT_LT(off_legs_m(routes, way), 0.16);
}

TEST(TaughtRoute, AWayDrivenThereAndBackIsOneWay) {
  const RouteGraph once = taught({}, drive({{0, 0}, {6, 0}, {6, 4}}, 3.0, 0.01));
  const RouteGraph twice = taught({}, drive({{0, 0}, {6, 0}, {6, 4}, {6, 0.1}, {0.1, 0}}, 3.0, 0.01));
  EXPECT_EQ(twice.nodes().size(), once.nodes().size());
  EXPECT_EQ(twice.legs().size(), once.legs().size());
}

TEST(TaughtRoute, JoinsTheRoutesThatThereAre) {
  std::vector<RouteNode> nodes(3);
  nodes[0].id = 4, nodes[0].position = {0, 0}, nodes[0].name = "Dock", nodes[0].station = true;
  nodes[1].id = 7, nodes[1].position = {10, 0};
  nodes[2].id = 9, nodes[2].position = {10, 5};
  const RouteGraph before(nodes, {{0, 1, 0, 0}, {1, 0, 0, 0}, {1, 2, 0, 0}});
  // from the middle of the first leg over new ground to the last node
  const RouteGraph routes = taught(before, drive({{5, 0.1}, {5, 5}, {9.8, 5.1}}, 3.0));
  ASSERT_EQ(routes.nodes().size(), 5U);  // one on the leg, one at the corner
  EXPECT_EQ(routes.nodes()[0].name, "Dock");
  const auto split = routes.index_of(10);
  ASSERT_TRUE(split);
  EXPECT_NEAR(routes.nodes()[*split].position.y_m, 0.0, 1e-9);
  EXPECT_FALSE(routes.has_leg(0, 1));
  EXPECT_TRUE(routes.has_leg(0, *split) && routes.has_leg(*split, 0));
  EXPECT_TRUE(routes.has_leg(*split, 1) && routes.has_leg(1, *split));
  EXPECT_TRUE(routes.has_leg(1, 2));
  EXPECT_FALSE(routes.has_leg(2, 1));  // one-way stays one-way
}

TEST(TaughtRoute, WhatIsShorterThanANodeTeachesNothing) {
  const RouteGraph before = taught({}, drive({{0, 0}, {3, 0}}));
  EXPECT_EQ(taught(before, drive({{1, 1}, {1.2, 1}})).nodes().size(), before.nodes().size());
  EXPECT_EQ(taught(before, {}).legs().size(), before.legs().size());
}

TEST(TaughtRoute, AJumpBeginsANewWay) {
  auto way = drive({{0, 0}, {3, 0}});
  note_way(way, stamp_from_seconds(2000), {7.0, 7.0, 0.0});
  EXPECT_EQ(way.size(), 1U);
}

}  // namespace
}  // namespace madori::planning
