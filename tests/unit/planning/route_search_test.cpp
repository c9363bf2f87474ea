#include "planning/route_graph/route_search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "planning/route_graph/route_csv.hpp"
#include "tests/support/published_routes.hpp"

namespace madori::planning {
namespace {

using ::testing::ElementsAre;

const RouteGraph& published() {
  static const RouteGraph kGraph = parse_routes(test::kPublishedTree, test::kPublishedPath).graph;
  return kGraph;
}

TEST(RouteSearch, FindsThePublishedWay) {
  const auto route = find_route(published(), 0, 4);
  ASSERT_TRUE(route);
  EXPECT_THAT(route.value().nodes, ElementsAre(0, 1, 3, 4));
  EXPECT_NEAR(route.value().length_m, std::hypot(1.8, 0.1) + std::hypot(0.54, 1.8) + std::hypot(0.12, 2.52),
              1e-12);
}

TEST(RouteSearch, RefusesThePublishedOneWayNodeAndFindsItTwoWay) {
  const auto refused = find_route(published(), 0, 5);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.reason(), "no way leads from node 0 to node 5");
  const auto found = find_route(published().symmetric(), 0, 5);
  ASSERT_TRUE(found);
  EXPECT_THAT(found.value().nodes, ElementsAre(0, 1, 2, 5));
}

TEST(RouteSearch, LeavesOutBlockedLegs) {
  const auto around = find_route(published(), 0, 4, RouteMetric::Hops, {{1, 3}});
  ASSERT_TRUE(around);
  EXPECT_THAT(around.value().nodes, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_FALSE(find_route(published(), 0, 4, RouteMetric::Metres, {{3, 4}}));
}

TEST(RouteSearch, MetresMayTakeMoreLegs) {
  const auto graph =
      parse_routes("ID,EDA\n0,1 2\n1,3\n2,4\n4,3\n", "ID,x,y\n0,0,0\n1,5,50\n2,1,0\n3,10,0\n4,2,0\n").graph;
  EXPECT_THAT(find_route(graph, 0, 3).value().nodes, ElementsAre(0, 1, 3));
  EXPECT_THAT(find_route(graph, 0, 3, RouteMetric::Metres).value().nodes, ElementsAre(0, 2, 4, 3));
}

/// Its path would need more waypoints than one may have: a vehicle sent over it has to be told, not stand.
TEST(RouteSearch, AWayThatNoFactoryHasIsNone) {
  const auto graph =
      parse_routes("ID,EDA\n0,1\n1,2\n2,\n", "ID,x,y\n0,0,0\n1,90000,0\n2,90000,20000\n").graph;
  EXPECT_TRUE(find_route(graph, 0, 1));
  for (const auto metric : {RouteMetric::Hops, RouteMetric::Metres}) {
    const auto far = find_route(graph, 0, 2, metric);
    ASSERT_FALSE(far);
    EXPECT_THAT(far.reason(), ::testing::HasSubstr("from node 0 to node 2 is longer than 100 km"));
  }
}

TEST(RouteSearch, TheStartItselfIsARouteOfLengthZero) {
  const auto route = find_route(published(), 3, 3);
  ASSERT_TRUE(route);
  EXPECT_THAT(route.value().nodes, ElementsAre(3));
  EXPECT_EQ(route.value().length_m, 0.0);
}

}  // namespace
}  // namespace madori::planning
