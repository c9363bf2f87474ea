#include "localization/drawing_fit/wall_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/angle.hpp"

namespace madori::localization {
namespace {

int by_arc_tangent(double normal_x, double normal_y) {
  double angle = std::atan2(normal_y, normal_x);
  if (angle < 0.0) angle += 2.0 * kPi;
  return std::min(static_cast<int>(angle / (2.0 * kPi / WallIndex::kDirections)), WallIndex::kDirections - 1);
}

TEST(WallIndex, DirectionsAreThoseOfTheArcTangent) {
  for (int x = -1; x <= 1; ++x)  // where directions meet
    for (int y = -1; y <= 1; ++y)
      if (x != 0 || y != 0) {
        EXPECT_EQ(WallIndex::direction_of(x, y), by_arc_tangent(x, y)) << x << ", " << y;
      }
  EXPECT_EQ(WallIndex::direction_of(-1.0, -0.0), by_arc_tangent(-1.0, -0.0));
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> turn(-kPi, kPi);
  for (int i = 0; i < 100'000; ++i) {
    const double angle = turn(engine);
    ASSERT_EQ(WallIndex::direction_of(std::cos(angle), std::sin(angle)),
              by_arc_tangent(std::cos(angle), std::sin(angle)))
        << angle;
  }
}

/// A wall of 0.25 m along x with two faces, the room in the south, and a partition of two faces that joins
/// it.
mapping::Walls walls_with_faces() {
  return {{1, {{0.0, 5.0}, {10.0, 5.0}}},
          {2, {{-0.25, 5.25}, {10.25, 5.25}}},
          {3, {{4.0, 0.0}, {4.0, 5.0}}},
          {4, {{4.2, 0.0}, {4.2, 5.0}}},
          {5, {{12.0, 0.0}, {12.0, 5.0}}}};
}

TEST(WallIndex, TheFarFaceOfAWallIsSeenByNobody) {
  const WallIndex index(walls_with_faces());
  const int south = WallIndex::direction_of(0.0, -1.0), north = WallIndex::direction_of(0.0, 1.0);
  for (double x = 0.2; x < 9.9; x += 0.1)  // also where the partition joins, and at the corners
    for (double y = 4.5; y < 6.0; y += 0.1) {
      ASSERT_EQ(index.nearest(x, y, south).wall, 0) << x << ", " << y;
      ASSERT_EQ(index.nearest(x, y, north).wall, 1) << x << ", " << y;
      ASSERT_NEAR(index.nearest(x, y, south).distance_m, y - 5.0, 1e-9);
    }
  const int west = WallIndex::direction_of(-1.0, 0.0), east = WallIndex::direction_of(1.0, 0.0);
  EXPECT_EQ(index.nearest(4.15, 2.0, west).wall, 2);
  EXPECT_EQ(index.nearest(4.05, 2.0, east).wall, 3);
  EXPECT_EQ(index.nearest(12.1, 2.0, west).wall, 4) << "a wall of one line is seen from both sides";
  EXPECT_EQ(index.nearest(11.9, 2.0, east).wall, 4);
}

TEST(VisibleFaces, WhatIsProbablyNoWallHidesNothingAndThreeLinesTellNothing) {
  mapping::Walls walls = walls_with_faces();
  walls[0].probability = 0.3;
  auto faces = visible_faces(walls);
  ASSERT_EQ(faces[1][1].size(), 1u) << "from the south, through a line that is no wall";
  EXPECT_NEAR(faces[1][1][0].to_m - faces[1][1][0].from_m, 10.5, 1e-9);
  EXPECT_TRUE(visible_faces(walls_with_faces())[1][1].empty());
  walls = walls_with_faces();
  walls.push_back({6, {{0.0, 5.5}, {10.0, 5.5}}});
  faces = visible_faces(walls);
  EXPECT_EQ(faces[1][0].size() + faces[1][1].size(), 2u) << "the middle of three";
  EXPECT_TRUE(faces[0][0].empty());
  EXPECT_TRUE(faces[5][1].empty());
}

}  // namespace
}  // namespace madori::localization
