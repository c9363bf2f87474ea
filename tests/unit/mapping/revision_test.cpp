#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/angle.hpp"
#include "core/segment_distance.hpp"
#include "mapping/revision/register_walls.hpp"
#include "mapping/revision/wall_changes.hpp"

namespace madori::mapping {
namespace {

using Walls2 = std::vector<Segment2<Map>>;

/// A hall with rooms of random sizes: no two alike.
Walls2 building(std::mt19937& random) {
  std::uniform_real_distribution<double> wide(3.0, 9.0);
  Walls2 walls{{{0, 0}, {60, 0}}, {{60, 0}, {60, 40}}, {{60, 40}, {0, 40}}, {{0, 40}, {0, 0}}};
  for (double x = wide(random); x < 56.0; x += wide(random)) {
    const double depth = wide(random);
    walls.push_back({{x, 0}, {x, depth}});
    walls.push_back({{x, 40}, {x, 40 - wide(random)}});
    walls.push_back({{x, depth}, {x + 1.5, depth}});
  }
  return walls;
}

/// What a sheet of another scale and place makes of them, ends a few centimetres off.
Walls2 on_sheet(const Walls2& walls, const Similarity& by, std::mt19937& random) {
  std::normal_distribution<double> off(0.0, 0.02);
  Walls2 sheet;
  for (const auto& wall : walls) {
    const auto noisy = [&](const Point2<Map>& p) {
      return moved(by, Point2<Map>{p.x_m + off(random), p.y_m + off(random)});
    };
    sheet.push_back(Segment2<Map>{noisy(wall.a), noisy(wall.b)});
  }
  return sheet;
}

class Revisions : public testing::TestWithParam<unsigned> {};

TEST_P(Revisions, EveryChangeIsFoundAndNothingElse) {
  std::mt19937 random(GetParam());
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Walls2 before = building(random);
  Walls2 after = before;
  const auto pick = [&] { return 4 + 3 * (random() % ((after.size() - 4) / 3)); };
  const std::size_t gone = pick();
  const Segment2<Map> removed = after[gone];
  after.erase(after.begin() + static_cast<std::ptrdiff_t>(gone));
  const Walls2 hall{{{60, 10}, {75, 10}}, {{75, 10}, {75, 28}}, {{75, 28}, {60, 28}}};
  after.insert(after.end(), hall.begin(), hall.end());
  const Similarity sheet{std::exp(4.0 * uniform(random)),
                         kPi * uniform(random),
                         {300.0 * uniform(random), 200.0 * uniform(random)}};
  const auto laid = register_walls(before, on_sheet(after, sheet, random), 0.15);
  ASSERT_TRUE(laid);
  EXPECT_NEAR(laid->old_from_new.scale * sheet.scale, 1.0, 1e-3);
  Walls2 now;
  for (const auto& wall : on_sheet(after, sheet, random)) now.push_back(moved(laid->old_from_new, wall));
  const auto missing = pieces_without(before, now);
  const auto added = pieces_without(now, before);
  ASSERT_EQ(missing.size(), 1U);
  EXPECT_LT(distance_m(missing[0], removed), 0.1);
  EXPECT_NEAR(missing[0].length_m(), removed.length_m(), 0.6);
  EXPECT_EQ(added.size(), hall.size());
}

INSTANTIATE_TEST_SUITE_P(Seeds, Revisions, testing::Range(1U, 7U));

TEST(Revision, WhatStaysIsAsProbableAsItWas) {
  const Walls walls{{7, {{0, 0}, {10, 0}}, 0.6}, {9, {{0, 5}, {10, 5}}, 0.8}};
  const Walls left = walls_without(walls, {{{4, 0}, {6, 0}}}, {.within = 1e-3, .shortest = 0.05});
  ASSERT_EQ(left.size(), 3U);
  for (std::size_t i = 0; i < left.size(); ++i) {
    EXPECT_EQ(left[i].id, static_cast<int>(i) + 1);
    EXPECT_EQ(left[i].probability, i < 2 ? 0.6 : 0.8);
  }
  EXPECT_EQ(left[2].segment, walls[1].segment);
}

TEST(Revision, AnotherBuildingIsNoRevision) {
  std::mt19937 random(7);
  const Walls2 one = building(random);
  Walls2 other;
  std::uniform_real_distribution<double> anywhere(0.0, 50.0);
  for (int i = 0; i < 40; ++i)
    other.push_back({{anywhere(random), anywhere(random)}, {anywhere(random), anywhere(random)}});
  EXPECT_FALSE(register_walls(one, other, 0.15));
}

}  // namespace
}  // namespace madori::mapping
