// How tests/bench/movers judges who is told to move.
#include "tests/bench/movers/mover_score.hpp"

#include <gtest/gtest.h>

#include "tests/bench/movers/mover_match.hpp"
#include "tests/bench/movers/nearest_neighbour.hpp"
#include "tests/bench/movers/plain_sight.hpp"
#include "tests/support/lidar_models.hpp"

namespace madori::bench {
namespace {

TrueMover person(const std::string& name, double x_m, double y_m, bool moves) {
  TrueMover mover{name, Traffic::Person, {}};
  mover.body.name = name;
  mover.body.centre = {x_m, y_m};
  mover.body.half_length_m = mover.body.half_width_m = 0.23;
  mover.body.z = {0.0, 1.75};
  mover.body.round = true;
  mover.vx_mps = moves ? 1.0 : 0.0;
  mover.moves = mover.asked = moves;
  mover.range_m = distance_to(mover.body, {0.0, 0.0});
  return mover;
}

TEST(MatchMovers, EachTrueOneHasTheNearestOfThoseTold) {
  const std::vector<TrueMover> truths{person("a", 3.0, 0.0, true), person("b", 3.6, 0.0, true)};
  const std::vector<ToldMover> told{{{3.4, 0.0}}, {{2.6, 0.0}}, {{3.3, 0.0}}};
  const Match match = match_movers(told, truths);
  EXPECT_EQ(match.told_of, (std::vector<int>{2, 0}));
  EXPECT_EQ(match.verdicts, std::vector<Verdict>(3, Verdict::Right)) << "a body told twice is told";
}

TEST(MatchMovers, WhoStandsIsNeitherRightNorWrong) {
  const std::vector<TrueMover> truths{person("stands", 3.0, 0.0, false), person("walks", 3.0, 5.0, true)};
  const Match match = match_movers({{{3.0, 0.1}}, {{3.0, 4.9}}, {{8.0, 0.0}}}, truths);
  EXPECT_EQ(match.verdicts, (std::vector<Verdict>{Verdict::Neither, Verdict::Right, Verdict::Wrong}));
  EXPECT_EQ(match.told_of, (std::vector<int>{Match::kNone, 1}));
}

TEST(MoverScore, CountsByRangeAndMeasuresErrors) {
  MoverScore score;
  const std::vector<TrueMover> truths{person("near", 2.0, 0.0, true), person("far", 12.0, 0.0, true)};
  score.add({}, {{{2.0, 0.33}, 0.6, 0.0, 0.2}, {{7.0, 0.0}, 1.0, 0.0, 0.2}}, truths, {0.0, 0.0});
  const FoundCounts& near = score.found(Traffic::Person, *range_of(1.77));
  ASSERT_EQ(near.found, 1);
  EXPECT_NEAR(near.outline_m[0], 0.1, 0.01);
  EXPECT_NEAR(near.centre_m[0], 0.33, 1e-9);
  EXPECT_NEAR(near.velocity_mps[0], 0.4, 1e-9);
  EXPECT_NEAR(near.along_mps[0], -0.4, 1e-9) << "too slow";
  EXPECT_EQ(score.found(Traffic::Person, *range_of(11.8)).asked, 1);
  EXPECT_EQ(score.found(Traffic::Person, *range_of(11.8)).found, 0);
  EXPECT_EQ(score.told(*range_of(7.0)).wrong(), 1);
  EXPECT_NEAR(f1_score(score), 2.0 * 0.5 * 1.0 / 1.5, 1e-9) << "12 m is out of its ranges";
}

TEST(MoverScore, TellsAfterHowLongSomebodyWasFound) {
  MoverScore score;
  const std::vector<TrueMover> truths{person("a", 2.0, 0.0, true), person("b", 2.0, 3.0, true)};
  for (int i = 0; i <= 15; ++i) {
    const std::vector<ToldMover> told(i >= 4 ? 1 : 0, ToldMover{{2.0, 0.0}, 1.0, 0.0, 0.2});
    score.add(stamp_from_seconds(0.1 * i), told, truths, {0.0, 0.0});
  }
  score.end();
  const FoundCounts& a = score.found(Traffic::Person, *range_of(1.8));
  const FoundCounts& b = score.found(Traffic::Person, *range_of(3.4));
  ASSERT_EQ(a.first_after_s.size(), 1U);
  EXPECT_NEAR(a.first_after_s[0], 0.4, 1e-6);
  EXPECT_EQ(a.never, 0);
  EXPECT_EQ(b.never, 1);
}

/// Points of a post's near side.
void add_post(PointCloud<Base>& scan, double x_m, double y_m) {
  for (int i = -3; i <= 3; ++i)
    scan.points.push_back({static_cast<float>(x_m), static_cast<float>(y_m + 0.06 * i), 0.5F, 0.0F, 0, 0});
}

TEST(NearestNeighbour, TellsWhatWentOnAndNotWhatStandsOrIsAWall) {
  const auto walls =
      std::make_shared<const planning::WallGrid>(std::vector<Segment2<Map>>{{{6.0, -5.0}, {6.0, 5.0}}});
  NearestNeighbour neighbour(walls, {});
  for (int i = 0; i <= 6; ++i) {
    PointCloud<Base> scan;
    scan.stamp = stamp_from_seconds(0.1 * i);
    add_post(scan, 3.0, -1.0 + 0.12 * i);
    add_post(scan, 4.0, 3.0);
    add_post(scan, 5.9, -1.0 + 0.12 * i);
    neighbour.update(scan, {});
  }
  const auto told = neighbour.faster_than(0.2);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_NEAR(told[0].at.y_m, -0.28, 1e-3);
  EXPECT_NEAR(told[0].vy_mps, 1.2, 1e-3);
  EXPECT_NEAR(told[0].vx_mps, 0.0, 1e-3);
}

TEST(PlainSight, WhoIsHalfHiddenIsNotInPlainSight) {
  simulation::Mesh mesh;
  mesh.add_sheet({{2.0, -3.0}, {2.0, 0.0}}, {0.0, 3.0}, simulation::Material::Wall);
  const simulation::RayCaster building(mesh);
  const LidarModel model = test::planar_lidar({0.0, 0.0, 0.25, 0.0});
  const LidarPlace lidar{model, {0.0, 0.0, 0.0}};
  const auto seen = [&](double y_m, const std::vector<simulation::Body>& others) {
    const auto body = person("somebody", 4.0, y_m, true).body;
    return is_in_plain_sight(beams_on(body, others, building, lidar));
  };
  EXPECT_TRUE(seen(1.0, {}));
  EXPECT_FALSE(seen(-1.0, {})) << "behind the wall";
  EXPECT_FALSE(seen(-0.1, {})) << "mostly";
  EXPECT_TRUE(seen(0.1, {})) << "less than half";
  EXPECT_FALSE(seen(1.0, {person("other", 2.0, 0.5, true).body}));
}

}  // namespace
}  // namespace madori::bench
