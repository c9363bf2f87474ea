#include "localization/wall_tracker/scale_bank.hpp"

#include <gtest/gtest.h>

#include "localization/wall_extraction/wall_extraction.hpp"
#include "localization/wall_tracker/wall_tracker.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/made_up_drive.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

mapping::Walls sized(const mapping::Walls& walls, double factor) {
  mapping::Walls result = walls;
  for (mapping::Wall& wall : result)
    for (Point2<Map>* p : {&wall.segment.a, &wall.segment.b}) *p = {p->x_m * factor, p->y_m * factor};
  return result;
}

std::vector<test::DriveMoment> drive(const mapping::Walls& building, unsigned seed) {
  std::mt19937 engine(seed);
  return test::drive(building, {{18.0, 3.0}, {18.0, 21.0}, {38.0, 21.0}, {38.0, 5.0}}, test::ten_hertz(60.0),
                     engine);
}

struct Found {
  double factor = 0.0;
  double worst_m = 0.0;  ///< over the last 10 m, on the drawing
  bool sleeps = false;
};

Found found(const mapping::Walls& drawing, const std::vector<test::DriveMoment>& moments, double factor) {
  WallTracker tracker(drawing);
  Found result;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    (void)tracker.on_odometry(moments[i].odometry);
    const auto pose = tracker.on_scan(moments[i].scan.stamp, extract_walls(moments[i].scan, {}));
    const auto& t = moments[i].truth;
    if (distance_m(t.translation(), moments.back().truth.translation()) < 10.0)
      result.worst_m = std::max(
          result.worst_m, distance_m(pose.map_from_base.translation(), {t.x_m() * factor, t.y_m() * factor}));
  }
  result.factor = tracker.scale().factor();
  result.sleeps = tracker.scale().sleeps();
  return result;
}

TEST(ScaleBank, FindsTheSizeOfABuildingThatIsNotAsLargeAsDrawn) {
  const mapping::Walls building = test::factory_floor();
  const auto moments = drive(building, 3);
  for (const double factor : {0.988, 0.99, 0.995, 1.004, 1.0113, 1.02}) {
    const Found f = found(sized(building, factor), moments, factor);
    EXPECT_NEAR(f.factor, factor, 4e-4) << factor;
    EXPECT_LT(f.worst_m, 0.04) << factor;
  }
}

TEST(ScaleBank, LeavesADrawingThatIsRightExactlyAsItIs) {
  const mapping::Walls building = test::factory_floor();
  for (unsigned seed = 4; seed < 7; ++seed) {
    const Found f = found(building, drive(building, seed), 1.0);
    EXPECT_EQ(f.factor, 1.0);
    EXPECT_TRUE(f.sleeps);
  }
}

TEST(ScaleBank, WallsThatStandElsewhereAreNoMatterOfSize) {
  const mapping::Walls building = test::factory_floor();
  mapping::Walls drawing = building;
  for (std::size_t i = 0; i < drawing.size(); i += 4) {
    const double d = i % 8 == 0 ? 0.3 : -0.2;
    for (Point2<Map>* p : {&drawing[i].segment.a, &drawing[i].segment.b}) *p = {p->x_m + d, p->y_m - d};
  }
  const Found f = found(drawing, drive(building, 8), 1.0);
  EXPECT_NEAR(f.factor, 1.0, 1e-3);
}

TEST(ScaleBank, BelievesNothingWhereASizeCannotBeSeen) {
  // Walls that face each other fit one size alone; a single wall fits any, the vehicle nearer or farther.
  mapping::Walls one;
  test::add_wall(one, 0.0, 0.0, 200.0, 0.0);
  ScaleBank bank;
  bank.start_at({20.0, 2.0, 0.0});
  const SegmentGrid grid(one);
  ScanPoints points;
  for (int i = -40; i <= 40; ++i) points.add(0.5 * i, -2.0);
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(bank.observe(points, grid, {0.5, 0.0, 0.0})) << i;
  EXPECT_EQ(bank.factor(), 1.0);
}

}  // namespace
}  // namespace madori::localization
