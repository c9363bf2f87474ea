#include "localization/warp/place_by_clearances.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "localization/warp/seen_clearances.hpp"

namespace madori::localization {
namespace {

/// A room of 6 x 4 m, drawn; another wall behind its right one.
const mapping::Walls kHall{{0, {{0.0, 0.0}, {6.0, 0.0}}},
                           {1, {{6.0, 0.0}, {6.0, 4.0}}},
                           {2, {{6.0, 4.0}, {0.0, 4.0}}},
                           {3, {{0.0, 4.0}, {0.0, 0.0}}},
                           {4, {{6.5, 0.0}, {6.5, 4.0}}}};
constexpr Point2<Map> kPlace{2.0, 1.0};
constexpr double kSigmaM = 0.3;  ///< of the place about where it is expected

void see(MemoryCloud& cloud, const Point2<Map>& from, const Point2<Map>& to) {
  const double length_m = distance_m(from, to);
  const double ux = (to.x_m - from.x_m) / length_m, uy = (to.y_m - from.y_m) / length_m;
  for (double m = 0.5 * kVoxelM; m < length_m; m += kVoxelM) {
    CloudSurface s;
    s.x_m = from.x_m + m * ux, s.y_m = from.y_m + m * uy;
    s.normal_x = -uy, s.normal_y = ux;
    cloud.push_back(s);
  }
}

/// The room as it stands, between these walls.
MemoryCloud room(double left_m, double low_m, double right_m, double high_m) {
  MemoryCloud cloud;
  see(cloud, {left_m, low_m}, {right_m, low_m});
  see(cloud, {right_m, low_m}, {right_m, high_m});
  see(cloud, {right_m, high_m}, {left_m, high_m});
  see(cloud, {left_m, high_m}, {left_m, low_m});
  return cloud;
}

void expect_place(const Point2<Map>& place, const Point2<Map>& wanted) {
  EXPECT_NEAR(place.x_m, wanted.x_m, 0.04);
  EXPECT_NEAR(place.y_m, wanted.y_m, 0.04);
}

TEST(PlaceByClearances, WhereNothingWasSeenItIsAsExpected) {
  const Point2<Map> place = place_by_clearances(kHall, {}, kPlace, {2.3, 0.8}, kSigmaM);
  EXPECT_EQ(place.x_m, 2.3);
  EXPECT_EQ(place.y_m, 0.8);
}

TEST(PlaceByClearances, ARoomElsewhereTakesThePlaceAlong) {
  for (const double beside_m : {-0.6, -0.31, 0.0, 0.17, 0.6})
    expect_place(
        place_by_clearances(kHall, room(beside_m, 0.2, 6.0 + beside_m, 4.2), kPlace, kPlace, kSigmaM),
        {2.0 + beside_m, 1.2});
}

TEST(PlaceByClearances, ANarrowRoomIsDividedAsItIsDrawn) {
  // 3.2 m between the lower and the upper wall, drawn 4 m.
  const Point2<Map> place = place_by_clearances(kHall, room(0.0, 0.0, 6.0, 3.2), kPlace, kPlace, kSigmaM);
  EXPECT_GT(place.y_m, 0.79);
  EXPECT_LT(place.y_m, 1.01);  // either wall's distance holds, or both their shares
  EXPECT_NEAR(place.x_m, 2.0, 0.04);
}

TEST(PlaceByClearances, WhatStandsBeforeAWallSaysNothing) {
  MemoryCloud cloud = room(0.0, 0.0, 6.0, 4.0);
  see(cloud, {0.5, 1.3}, {0.5, 0.7});
  expect_place(place_by_clearances(kHall, cloud, kPlace, {2.1, 1.1}, kSigmaM), kPlace);
}

TEST(PlaceByClearances, WhatIsNotDrawnPushesNothingAwayInAnOpenHall) {
  const mapping::Walls far{{0, {{-20.0, -20.0}, {20.0, -20.0}}}};
  MemoryCloud cloud;
  see(cloud, {3.0, 0.4}, {3.0, 1.6});
  const Point2<Map> place = place_by_clearances(far, cloud, kPlace, kPlace, kSigmaM);
  EXPECT_NEAR(place.x_m, kPlace.x_m, 0.02);
  EXPECT_NEAR(place.y_m, kPlace.y_m, 0.02);
}

TEST(PlaceByClearances, APlaceThatIsSurerMovesLess) {
  const MemoryCloud beside = room(0.6, 0.0, 6.6, 4.0);
  EXPECT_NEAR(place_by_clearances(kHall, beside, kPlace, kPlace, 0.3).x_m, 2.6, 0.04);
  EXPECT_NEAR(place_by_clearances(kHall, beside, kPlace, kPlace, 0.05).x_m, 2.0, 0.15);
}

TEST(SeenClearances, ABeamThatLooksPastAnEdgeIsNoClearance) {
  MemoryCloud cloud;
  see(cloud, {2.0, -1.0}, {2.0, 0.0});
  see(cloud, {4.0, -1.0}, {4.0, 1.0});
  const SeenClearances ahead(0.0, cloud);
  EXPECT_NEAR(ahead.nearest(0.0, -0.5)[0], 2.0, 1e-9);
  const auto of_walls = [&](double x, double y) { return ahead.of_walls(ahead.nearest(x, y), x, y); };
  EXPECT_NEAR(of_walls(0.0, -0.5)[0], 2.0, 1e-9);
  EXPECT_NEAR(ahead.nearest(0.0, -0.02)[0], 2.0, 1e-9);
  EXPECT_TRUE(std::isinf(of_walls(0.0, -0.02)[0]));  // 3 degrees to the left it is 4 m
  EXPECT_NEAR(of_walls(0.0, 0.4)[0], 4.0, 1e-9);
  EXPECT_TRUE(std::isinf(of_walls(0.0, 0.4)[1]));  // nothing was seen behind
}

}  // namespace
}  // namespace madori::localization
