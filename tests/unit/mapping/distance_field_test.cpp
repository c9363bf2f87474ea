#include "mapping/wall_map/distance_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/result.hpp"

namespace madori::mapping {
namespace {

Walls random_walls(int count, std::mt19937& engine) {
  std::uniform_real_distribution<double> at(-8.0, 12.0);
  Walls walls;
  for (int i = 0; i < count; ++i) walls.push_back({i, {{at(engine), at(engine)}, {at(engine), at(engine)}}});
  walls.push_back({count, {{3.0, 4.0}, {3.0, 4.0}}});  // a point
  walls.push_back({count + 1, {{-2.0, 5.0}, {6.0, 5.0}}});
  walls.push_back({count + 2, {{1.0, -6.0}, {1.0, 2.0}}});
  return walls;
}

double nearest_wall_m(const Walls& walls, const Point2<Map>& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Wall& wall : walls) nearest = std::min(nearest, squared_distance_m2(wall.segment, p));
  return std::sqrt(nearest);
}

TEST(DistanceField, IsWhatBruteForceFinds) {
  std::mt19937 engine(1);
  for (int round = 0; round < 5; ++round) {
    const Walls walls = random_walls(6, engine);
    const DistanceField field(walls, {.cell_m = 0.11, .max_distance_m = 2.0, .margin_m = 1.0});
    const GridFrame& frame = field.frame();
    for (int row = 0; row < frame.height; ++row)
      for (int column = 0; column < frame.width; ++column) {
        const Point2<Map> centre = frame.centre(column, row);
        const double exact = std::min(nearest_wall_m(walls, centre), 2.0);
        ASSERT_NEAR(field.distance_m(centre), exact, field.m_per_count() * 0.5001);
      }
  }
}

TEST(DistanceField, IsFarOutsideTheGridAndForNoWalls) {
  const DistanceField field(Walls{{0, {{0.0, 0.0}, {1.0, 0.0}}}});
  for (const double far : {-1e9, 1e9, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(field.distance_m({far, 0.0}), field.max_distance_m());
  EXPECT_EQ(DistanceField(Walls{}).distance_m({0.0, 0.0}), 2.55);
}

TEST(DistanceField, HoldsTheMarginAround) {
  const DistanceField field(Walls{{0, {{0.0, 0.0}, {1.0, 0.0}}}}, {.margin_m = 1.5});
  for (const Point2<Map>& corner : {Point2<Map>{-1.49, -1.49}, Point2<Map>{2.49, 1.49}})
    EXPECT_GE(field.frame().find(corner), 0);
}

TEST(DistanceField, RefusesADrawingOfKilometres) {
  EXPECT_THROW(DistanceField(Walls{{0, {{0.0, 0.0}, {5e4, 5e4}}}}), Error);
}

}  // namespace
}  // namespace madori::mapping
