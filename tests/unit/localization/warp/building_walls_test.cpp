#include <gtest/gtest.h>

#include "core/segment_distance.hpp"
#include "localization/warp/warp_fit.hpp"
#include "tests/support/made_up_buildings.hpp"

namespace madori::localization {
namespace {

TEST(WallsInBuilding, AnExactDrawingStaysAsItIs) {
  const mapping::Walls walls = test::laboratory_hall();
  const mapping::Walls made = walls_in_building(walls, {});
  ASSERT_EQ(made.size(), walls.size());
  for (std::size_t i = 0; i < walls.size(); ++i) {
    EXPECT_LT(distance_m(made[i].segment.a, walls[i].segment.a), 1e-12);
    EXPECT_LT(distance_m(made[i].segment.b, walls[i].segment.b), 1e-12);
  }
}

TEST(WallsInBuilding, ABentWallBecomesPiecesOnTheCurve) {
  mapping::Walls walls;
  test::add_wall(walls, 0.0, 0.0, 20.0, 0.0);
  WarpField field;
  field.origin = {-8.0, -8.0};
  field.spacing_m = 4.0;
  field.width = 10;
  field.height = 5;
  for (int p = 0; p < 50; ++p) {
    field.control_m.push_back(0.0);
    field.control_m.push_back(p % 10 == 4 ? 1.0 : 0.0);
    field.sigma_m.push_back(0.05);
  }
  WarpFit fit;
  fit.warp = DrawingWarp({}, field, {});
  const mapping::Walls made = walls_in_building(walls, fit);
  ASSERT_EQ(made.size(), 10U);
  for (double x = 0.0; x <= 20.0; x += 0.25) {
    const Point2<Building> p = fit.warp.building(Point2<Map>{x, 0.0});
    double nearest = 1e9;
    for (const mapping::Wall& wall : made)
      nearest = std::min(nearest, distance_m(wall.segment, Point2<Map>{p.x_m, p.y_m}));
    EXPECT_LT(nearest, 0.05);
  }
}

TEST(WallsInBuilding, ALineSeenFromBothSidesBecomesTwoFaces) {
  mapping::Walls walls;
  test::add_wall(walls, 0.0, 0.0, 4.0, 0.0);
  WarpFit fit;
  fit.warp = DrawingWarp({}, {}, {0.1, 15.0, 0.05, 0.02, 0.7});
  fit.walls.push_back({{{{0.075, 0.01, 4.0, 1.0}, {-0.075, 0.01, 4.0, 1.0}}}});
  const mapping::Walls made = walls_in_building(walls, fit);
  ASSERT_EQ(made.size(), 2U);
  EXPECT_NEAR(made[0].segment.a.y_m, 0.075, 1e-12);
  EXPECT_NEAR(made[1].segment.b.y_m, -0.075, 1e-12);
  fit.walls[0].sides[1].offset_m = 0.07;  // the same within what is known
  EXPECT_EQ(walls_in_building(walls, fit).size(), 1U);
}

}  // namespace
}  // namespace madori::localization
