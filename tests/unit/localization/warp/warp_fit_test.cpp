#include "localization/warp/warp_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/segment_distance.hpp"
#include "localization/warp/bent_drawing.hpp"
#include "localization/warp/other_ways.hpp"
#include "tests/support/bent_memory.hpp"

namespace madori::localization {
namespace {

using test::BentBuilding;
using test::BentBuildingOptions;
using test::BentMemoryOptions;
using test::BuildingKind;

MemoryCloud seen_on_lap(const BentBuilding& building, double clutter) {
  BentMemoryOptions options;
  options.metres = 50.0;
  options.clutter = clutter;
  return memory_cloud(test::bent_memory(building, options));
}

/// Errors of the poses of the lap carried onto the drawing, sorted.
std::vector<double> errors_m(const BentBuilding& building, const DrawingWarp& warp) {
  std::vector<double> errors;
  for (const Point2<Map>& p : test::along_lap(building, 0.5, 50.0))
    errors.push_back(distance_m(warp.map(building.warp->building(p)), p));
  std::sort(errors.begin(), errors.end());
  return errors;
}

class WarpFitOfKind : public testing::TestWithParam<BuildingKind> {};

TEST_P(WarpFitOfKind, AnExactDrawingIsIdentityInClutter) {
  BentBuildingOptions options;
  options.kind = GetParam();
  options.amplitude_m = 0.0;
  options.furniture = 0.3;
  const BentBuilding building = test::bent_building(options);
  const WallIndex index(building.drawn);
  const WarpFit fit = fit_warp_from_start(index, seen_on_lap(building, 0.3));
  EXPECT_LT(errors_m(building, fit.warp).back(), 0.001);
  EXPECT_TRUE(fit.warp.is_identity());
  EXPECT_LT(fit.evidence_nats, 0.0);
  EXPECT_FALSE(fit.next.is_identity());  // the field goes on, believed or not
}

TEST_P(WarpFitOfKind, ABentDrawingIsFoundOut) {
  BentBuildingOptions options;
  options.kind = GetParam();
  options.amplitude_m = 0.6;
  options.scale = 0.985;
  const BentBuilding building = test::bent_building(options);
  const WallIndex index(building.drawn);
  const WarpFit fit = fit_warp_from_start(index, seen_on_lap(building, 0.05));
  const std::vector<double> errors = errors_m(building, fit.warp);
  EXPECT_LT(errors[errors.size() / 2], 0.10);
  EXPECT_LT(errors[errors.size() * 95 / 100], 0.35);
  EXPECT_GT(fit.evidence_nats, 50.0);
  EXPECT_NEAR(fit.warp.similarity().scale, 1.0 / options.scale, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Kinds, WarpFitOfKind,
                         testing::Values(BuildingKind::Office, BuildingKind::Hall, BuildingKind::Corridors));

TEST(WarpFit, FindsTheSizeOfADrawingThatIsRightOtherwise) {
  for (const double scale : {0.98, 1.02}) {
    BentBuildingOptions options;
    options.amplitude_m = 0.0;
    options.scale = scale;
    const BentBuilding building = test::bent_building(options);
    const WallIndex index(building.drawn);
    const WarpFit fit = fit_warp_from_start(index, seen_on_lap(building, 0.1));
    EXPECT_NEAR(fit.warp.similarity().scale * scale, 1.0, 0.002);
    EXPECT_LT(errors_m(building, fit.warp).back(), 0.05);
  }
}

TEST(WarpFit, AWallDrawnHalfAMetreOffIsToldAndBendsNothing) {
  BentBuildingOptions options;
  options.amplitude_m = 0.0;
  options.straight_drawing = true;
  BentBuilding building = test::bent_building(options);
  const MemoryCloud cloud = seen_on_lap(building, 0.1);
  // The lower wall of the building, seen through the doors of many rooms, and a partition.
  std::size_t moved = 0;
  const auto seen = fit_warp(WallIndex(building.drawn), cloud, {}).walls;
  for (std::size_t i = 0; i < building.drawn.size(); ++i)
    if (building.drawn[i].segment.length_m() < 8.0 && seen[i].seen_m() > seen[moved].seen_m()) moved = i;
  Segment2<Map>& s = building.drawn[moved].segment;
  const double length = s.length_m();
  const Point2<Map> by{-0.5 * (s.b.y_m - s.a.y_m) / length, 0.5 * (s.b.x_m - s.a.x_m) / length};
  s = {{s.a.x_m + by.x_m, s.a.y_m + by.y_m}, {s.b.x_m + by.x_m, s.b.y_m + by.y_m}};
  const WarpFit fit = fit_warp_from_start(WallIndex(building.drawn), cloud);
  EXPECT_NEAR(fit.walls[moved].offset_m(), -0.5, 0.03);
  const auto& [left, right] = fit.walls[moved].sides;
  EXPECT_LT((left.seen_m > right.seen_m ? left : right).sigma_m, 0.1);
  EXPECT_LT(errors_m(building, fit.warp).back(), 0.001);
}

/// What a person told of the place is part of what an explanation is worth, and so are the odds of the
/// others.
TEST(WarpFit, WhatWasToldWeighsTheEnds) {
  BentBuildingOptions options;
  options.amplitude_m = 0.6;
  const BentBuilding building = test::bent_building(options);
  const WallIndex index(building.drawn);
  const MemoryCloud cloud = seen_on_lap(building, 0.05);
  const DrawingWarp beside({1.0, 0.0, 0.8, 0.0}, {}, {});
  const WarpFit alone = fit_warp(index, cloud, {}, {beside});
  ASSERT_FALSE(alone.warp.is_identity());
  const auto as_drawn = [](const DrawingWarp& warp) { return warp.is_identity() ? 0.0 : -1e4; };
  const WarpFit told = fit_warp(index, cloud, {}, {beside}, as_drawn);
  EXPECT_TRUE(told.warp.is_identity());
  EXPECT_EQ(told.others.front().odds, 0.0);
  const WarpFit indifferent = fit_warp(index, cloud, {}, {beside}, [](const DrawingWarp&) { return -7.0; });
  EXPECT_EQ(indifferent.warp, alone.warp);
  EXPECT_NEAR(indifferent.evidence_nats, alone.evidence_nats, 1e-9);
}

/// Racks and bays look like their neighbours, and a fit that follows a growing memory may take one for the
/// other: of 25 places of this building it is 13 times more than 0.8 m off.
TEST(WarpFit, SurroundingsTakenForTheirNeighboursAreFoundOut) {
  const BentBuilding building = test::bent_building(test::hard_building(12, 1.0));
  const WallIndex index(building.drawn);
  const MemoryCloud cloud = seen_on_lap(building, 0.05);
  const auto way = test::along_lap(building, 0.5, 50.0);
  DrawingWarp alone, compared;
  int alone_off = 0, compared_off = 0;
  for (int until = 4; until < static_cast<int>(way.size()); until += 4) {
    MemoryCloud seen;
    std::copy_if(cloud.begin(), cloud.end(), std::back_inserter(seen),
                 [&](const CloudSurface& s) { return s.keyframe <= until; });
    const Point2<Map>& here = way[static_cast<std::size_t>(until)];
    const Point2<Building> at = building.warp->building(here);
    alone = fit_warp(index, seen, alone).warp;
    compared = fit_warp(index, seen, compared, other_ways(index, seen, compared, at)).warp;
    alone_off += distance_m(alone.map(at), here) > 0.8 ? 1 : 0;
    compared_off += distance_m(compared.map(at), here) > 0.8 ? 1 : 0;
  }
  EXPECT_GE(alone_off, 5);
  EXPECT_LE(compared_off, 1);
}

/// A fit that followed the memory alone has taken rooms for their neighbours: they are set right though the
/// vehicle stands elsewhere.
TEST(WarpFit, RoomsTakenForTheirNeighboursAreFoundOutFromAfar) {
  const BentBuilding building = test::bent_building(test::hard_building(12, 1.0));
  const WallIndex index(building.drawn);
  const MemoryCloud cloud = seen_on_lap(building, 0.05);
  const auto way = test::along_lap(building, 0.5, 50.0);
  const auto off = [&](const DrawingWarp& warp) {
    return std::count_if(way.begin(), way.end(), [&](const Point2<Map>& p) {
      return distance_m(warp.map(building.warp->building(p)), p) > 0.8;
    });
  };
  WarpFit fit = fit_warp_from_start(index, cloud);
  const auto off_alone = off(fit.warp);
  for (int k = 0; k < 6; ++k)
    fit = fit_warp(index, cloud, fit.warp,
                   other_ways(index, cloud, fit.warp, building.warp->building(way.front())));
  EXPECT_GE(off_alone, 40);
  EXPECT_LE(off(fit.warp), 5);
}

TEST(WarpFit, AStartFromWhichNothingBelongsToAWallIsOneOfTheOthers) {
  const BentBuilding building = test::bent_building({});
  const WallIndex index(building.drawn);
  const MemoryCloud cloud = seen_on_lap(building, 0.05);
  const WarpFit alone = fit_warp(index, cloud, {});
  const WarpFit compared = fit_warp(index, cloud, {}, {DrawingWarp({1.0, 0.0, 5000.0, 0.0}, {}, {})});
  EXPECT_EQ(compared.warp, alone.warp);
  const WarpFit nowhere = fit_warp(index, cloud, DrawingWarp({1.0, 0.0, 5000.0, 0.0}, {}, {}));
  EXPECT_TRUE(std::isfinite(nowhere.evidence_nats));
}

TEST(BentDrawing, IsAsSureOfAPlaceAsTheOtherWaysAllow) {
  const auto shifted = [](double x_m) { return DrawingWarp({1.0, 0.0, x_m, 0.0}, {}, {}); };
  BentDrawing bent;
  bent.fit.warp = shifted(0.0);
  EXPECT_EQ(bent.share_within({}, 0.5), 1.0);
  bent.fit.others = {{shifted(0.3), 1.0}, {shifted(2.0), 1.0}};
  EXPECT_NEAR(bent.share_within({}, 0.5), 2.0 / 3.0, 1e-12);
  bent.fit.others[1].odds = 1e-4;
  EXPECT_GT(bent.share_within({}, 0.5), 0.999);
}

}  // namespace
}  // namespace madori::localization
