#include "localization/placement/survey.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "localization/pose_axes.hpp"
#include "tests/support/made_up_buildings.hpp"

namespace madori::localization {
namespace {

/// What a vehicle sees of the walls within 12 m: a piece every 0.2 m that looks at it.
MemoryCloud seen_from(const Point2<Map>& here, const mapping::Walls& walls) {
  MemoryCloud cloud;
  for (const mapping::Wall& wall : walls) {
    const Segment2<Map>& s = wall.segment;
    const double length_m = s.length_m();
    const double along_x = (s.b.x_m - s.a.x_m) / length_m, along_y = (s.b.y_m - s.a.y_m) / length_m;
    const double left = along_x * (here.y_m - s.a.y_m) - along_y * (here.x_m - s.a.x_m);
    const double sign = left < 0.0 ? -1.0 : 1.0;
    for (double m = 0.1; m < length_m; m += kVoxelM) {
      const Point2<Map> at{s.a.x_m + m * along_x, s.a.y_m + m * along_y};
      if (distance_m(at, here) > 12.0) continue;
      const double nx = -sign * along_y, ny = sign * along_x;
      cloud.push_back({at.x_m, at.y_m, nx, ny, 0, WallIndex::direction_of(nx, ny), 1, 1.0, 1.0});
    }
  }
  return cloud;
}

TEST(Survey, ThePlaceIsAmongTheLikeliestWhereverTheMemoryBeganAndHoweverItIsTurned) {
  const mapping::Walls walls = test::factory_floor();
  const WallIndex index(walls);
  std::mt19937 engine(4);
  std::uniform_real_distribution<double> x(3.0, 77.0), y(5.0, 45.0), turn(-kPi, kPi), shift(-60.0, 60.0);
  for (int trial = 0; trial < 20; ++trial) {
    const Transform2<Map, Base> place(x(engine), y(engine), turn(engine));
    const MemoryCloud seen = seen_from(place.translation(), walls);
    const Transform2<Map, Map> moved_by(shift(engine), shift(engine), turn(engine));
    const Transform2<Map, Base> at = moved_by * place;
    const auto found = survey(index, moved(seen, moved_by), at, 30);
    EXPECT_LE(found.size(), 30U);
    EXPECT_TRUE(std::any_of(
        found.begin(), found.end(),
        [&](const auto& correction) { return same_place(correction * at, place, 0.6, to_rad(6.0)); }))
        << place.x_m() << ", " << place.y_m();
    for (std::size_t i = 0; i < found.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        EXPECT_FALSE(same_place(found[i] * at, found[k] * at, 0.9, to_rad(10.0)));
  }
}

TEST(Survey, OfNoDrawingNothingIsFound) {
  EXPECT_TRUE(survey(WallIndex(mapping::Walls{}), {}, {}, 30).empty());
}

}  // namespace
}  // namespace madori::localization
