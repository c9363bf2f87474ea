#include "localization/warp/place_by_walls.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.hpp"

namespace madori::localization {
namespace {

/// A room of 6 x 4 m, drawn; another wall behind its right one.
const mapping::Walls kRoom{{0, {{0.0, 0.0}, {6.0, 0.0}}},
                           {1, {{6.0, 0.0}, {6.0, 4.0}}},
                           {2, {{6.0, 4.0}, {0.0, 4.0}}},
                           {3, {{0.0, 4.0}, {0.0, 0.0}}},
                           {4, {{6.5, 0.0}, {6.5, 4.0}}}};

/// Each wall seen whole from within, where it stands beside its place by this much of its left normal:
/// inward.
WarpFit seen(const std::array<double, 4>& inward_m) {
  WarpFit fit;
  fit.walls.resize(kRoom.size());
  for (std::size_t i = 0; i < 4; ++i) fit.walls[i].sides[0] = {inward_m[i], 0.02, 4.0, 1.0};
  fit.walls[4].sides[0] = {3.0, 0.02, 4.0, 1.0};  // hidden from the room
  return fit;
}

TEST(PlaceByWalls, WithoutOffsetsItIsTheWarps) {
  WarpFit fit = seen({});
  fit.warp = DrawingWarp({1.02, to_rad(2.0), 0.4, -0.2}, {}, {});
  const Point2<Map> place = place_by_walls(kRoom, fit, {1.5, 1.0});
  EXPECT_NEAR(place.x_m, fit.warp.building(Point2<Map>{1.5, 1.0}).x_m, 1e-12);
  EXPECT_NEAR(place.y_m, fit.warp.building(Point2<Map>{1.5, 1.0}).y_m, 1e-12);
}

TEST(PlaceByWalls, AShiftedRoomTakesThePlaceAlong) {
  const Point2<Map> place = place_by_walls(kRoom, seen({0.0, -0.3, 0.0, 0.3}), {3.0, 1.0});
  EXPECT_NEAR(place.x_m, 3.3, 0.03);
  EXPECT_NEAR(place.y_m, 1.0, 1e-9);
}

TEST(PlaceByWalls, AWiderRoomIsDividedAsItIsDrawn) {
  const Point2<Map> place = place_by_walls(kRoom, seen({-0.4, 0.0, 0.0, 0.0}), {3.0, 1.0});
  // Drawn 1 m from the lower of two walls 4 m apart, which stand 4.4 m apart: 1.1 m.
  EXPECT_NEAR(place.y_m, -0.4 + 1.1, 0.05);
}

TEST(PlaceByWalls, WhatWasNotSeenMovesNothing) {
  WarpFit fit = seen({0.0, -0.3, 0.0, 0.3});
  for (auto& wall : fit.walls) wall.sides[0].seen_m = 0.1;
  EXPECT_NEAR(place_by_walls(kRoom, fit, {3.0, 1.0}).x_m, 3.0, 1e-12);
}

}  // namespace
}  // namespace madori::localization
