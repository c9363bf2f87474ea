#include "tests/support/bent_building.hpp"

#include <gtest/gtest.h>

#include "core/segment_distance.hpp"

namespace madori::test {
namespace {

double nearest_m(const mapping::Walls& walls, const Segment2<Map>& s) {
  double nearest = 1e9;
  for (const mapping::Wall& wall : walls) nearest = std::min(nearest, distance_m(wall.segment, s));
  return nearest;
}

/// The leg as the vehicle drives it: straight on the drawing, carried to the building.
double standing_clearance(const BentBuilding& made, const Segment2<Map>& leg) {
  double nearest = 1e9;
  for (int k = 0; k <= 8; ++k) {
    const double t = k / 8.0;
    const Point2<Building> p = made.warp->building(
        {leg.a.x_m + t * (leg.b.x_m - leg.a.x_m), leg.a.y_m + t * (leg.b.y_m - leg.a.y_m)});
    const Point2<Map> q{p.x_m, p.y_m};
    nearest = std::min(nearest, nearest_m(made.truth, {q, q}));
  }
  return nearest;
}

TEST(BentBuilding, RoutesAreFreeOnTheDrawingAndInTruth) {
  for (std::uint32_t seed = 1; seed <= 9; ++seed) {
    const BentBuilding made = bent_building(hard_building(seed, seed % 2 == 0 ? 1.0 : 0.3));
    for (const auto& leg : made.routes.legs()) {
      const Segment2<Map> s{made.routes.nodes()[leg.from].position, made.routes.nodes()[leg.to].position};
      EXPECT_GT(nearest_m(made.drawn, s), 0.55) << "drawn, seed " << seed;
      EXPECT_GT(standing_clearance(made, s), 0.55) << "true, seed " << seed;
    }
    for (std::size_t i = 0; i + 1 < made.lap.size(); ++i)
      EXPECT_TRUE(made.routes.has_leg(made.lap[i], made.lap[i + 1]));
  }
}

TEST(BentBuilding, TheWarpIsInvertibleAsLargeAsAskedForAndNotSteeper) {
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    for (const double amplitude : {0.1, 0.3, 0.6, 1.0}) {
      BentBuildingOptions options = hard_building(seed, amplitude);
      const BentBuilding made = bent_building(options);
      EXPECT_NEAR(made.warp->largest_m(), amplitude, 1e-9);
      EXPECT_LE(made.warp->most_strain(), options.most_strain + 1e-9);
      for (double x = 0.0; x < made.width_m; x += 3.7) {
        const Point2<Map> p{x, 0.4 * made.height_m};
        EXPECT_LT(distance_m(made.warp->map(made.warp->building(p)), p), 1e-6);
      }
    }
  }
}

TEST(BentBuilding, WallsStandWhereTheWarpSaysButForShiftsAndInventions) {
  BentBuildingOptions options;
  options.amplitude_m = 0.6;
  options.scale = 1.015;
  options.room_sigma_m = 0.2;
  options.invented = 0.1;
  for (const bool straight : {false, true}) {
    options.straight_drawing = straight;
    const BentBuilding made = bent_building(options);
    ASSERT_EQ(made.drawn.size(), made.drawn_walls.size());
    for (std::size_t i = 0; i < made.drawn.size(); ++i) {
      if (made.drawn_walls[i].invented) continue;
      const Point2<Map>& a = made.drawn[i].segment.a;
      const Point2<Map>& by = made.drawn_walls[i].shift;
      const Point2<Building> q = made.warp->building({a.x_m - by.x_m, a.y_m - by.y_m});
      EXPECT_LT(nearest_m(made.truth, {{q.x_m, q.y_m}, {q.x_m, q.y_m}}), 1e-6);
    }
  }
}

TEST(BentBuilding, AnExactDrawingIsTheBuilding) {
  BentBuildingOptions options;
  options.amplitude_m = 0.0;
  const BentBuilding made = bent_building(options);
  EXPECT_EQ(made.drawn.size(), made.truth.size());
  for (std::size_t i = 0; i < made.drawn.size(); ++i) {
    EXPECT_LT(distance_m(made.drawn[i].segment.a, made.truth[i].segment.a), 1e-9);
    EXPECT_LT(distance_m(made.drawn[i].segment.b, made.truth[i].segment.b), 1e-9);
  }
}

}  // namespace
}  // namespace madori::test
