#include "localization/wall_reliability/wall_reliability.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "localization/scan_points.hpp"
#include "localization/wall_reliability/reliability_file.hpp"
#include "localization/wall_reliability/wall_weights.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/made_up_drive.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::localization {
namespace {

constexpr std::size_t kScreen = 30;  // of laboratory_hall(): the screen at x = 11, torn down below
constexpr std::size_t kEastWall = 5;
constexpr double kMovedM = 0.4;  // the east wall stands so much further in

const std::vector<Point2<Map>> kRound{{2.0, 1.2},  {7.0, 1.2},  {11.0, 1.2}, {14.5, 1.0}, {14.4, 4.5},
                                      {14.0, 8.0}, {10.2, 7.6}, {7.2, 7.6},  {7.0, 4.0},  {6.8, 1.3}};

/// The building that the drawing shows almost rightly.
mapping::Walls building() {
  mapping::Walls walls = test::laboratory_hall();
  for (Point2<Map>* p : {&walls[kEastWall].segment.a, &walls[kEastWall].segment.b}) p->x_m -= kMovedM;
  walls.erase(walls.begin() + static_cast<long>(kScreen));
  return walls;
}

SurfaceScan surfaces(const LaserScan& scan) {
  const ScanPoints points = scan_points(scan, {});
  std::vector<Point2<Base>> list;
  for (std::size_t i = 0; i < points.size(); ++i) list.push_back(points.point(i));
  return make_surface_scan(scan.stamp, {}, list);
}

PoseEstimate sure(const Transform2<Map, Base>& pose) {
  return {{}, pose, Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal(), {LocalizationState::Localized, ""}};
}

std::vector<test::DriveMoment> round_trip(const mapping::Walls& walls, unsigned seed) {
  std::mt19937 engine(seed);
  test::DriveSettings settings;
  settings.lidar = test::full_turn(540, 30.0);
  settings.lidar.range_sigma_m = 0.015;
  settings.lidar.clutter = 0.2;
  return test::drive(walls, kRound, settings, engine);
}

void learn(WallReliability& reliability, const std::vector<test::DriveMoment>& moments) {
  for (const auto& m : moments)
    if (m.has_scan) reliability.observe(surfaces(m.scan), sure(m.truth));
}

TEST(WallCells, TileTheWallsAndAreFoundByPlace) {
  const mapping::Walls walls = test::laboratory_hall();
  const WallCells cells(walls);
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> at(0.0, 1.0);
  for (std::size_t w = 0; w < walls.size(); ++w) {
    double sum = 0.0;
    for (std::size_t c = cells.first(w); c < cells.first(w + 1); ++c) {
      sum += cells.all()[c].segment.length_m();
      EXPECT_EQ(cells.all()[c].wall, w);
      EXPECT_EQ(cells.at(w, sum - 1e-6), c);
    }
    EXPECT_NEAR(sum, walls[w].segment.length_m(), 1e-9);
  }
  for (int i = 0; i < 50; ++i) {
    const Point2<Map> p{22.0 * at(engine) - 1.0, 12.0 * at(engine) - 1.0};
    const double radius = 5.0 * at(engine);
    const auto found = cells.near(p, radius);
    for (std::uint32_t c = 0; c < cells.size(); ++c) {
      const auto& s = cells.all()[c].segment;
      const Point2<Map> middle{0.5 * (s.a.x_m + s.b.x_m), 0.5 * (s.a.y_m + s.b.y_m)};
      if (distance_m(middle, p) > radius) continue;
      EXPECT_TRUE(std::binary_search(found.begin(), found.end(), c));
    }
  }
}

TEST(WallLooks, OnAnExactDrawingNothingIsMissedAndNothingIsBeside) {
  const mapping::Walls walls = test::laboratory_hall();
  const WallCells cells(walls);
  const WallIndex index(walls);
  const mapping::DistanceField field(walls);
  std::mt19937 engine(4);
  int ended = 0;
  for (int i = 0; i < 40; ++i) {
    const auto pose = test::random_pose(walls, field, 0.5, 4.0, engine);
    const auto scan = test::simulate_scan(walls, pose, test::full_turn(720, 30.0), engine);
    for (const WallLook& look : wall_looks(cells, index, surfaces(scan), pose, Eigen::Matrix3d::Zero())) {
      EXPECT_EQ(look.passed, 0) << "wall " << cells.all()[look.cell].wall;
      if (look.ended < 3) continue;
      EXPECT_NEAR(look.offset_m, 0.0, 1e-3) << "wall " << cells.all()[look.cell].wall;
      ended += look.ended;
    }
  }
  EXPECT_GT(ended, 5000);
}

TEST(WallLooks, TheOffsetHasTheSignOfTheLeftSideAndThePosesUncertainty) {
  mapping::Walls walls;
  test::add_wall(walls, 0.0, 0.0, 6.0, 0.0);  // left of a -> b is up
  const WallCells cells(walls);
  mapping::Walls real = walls;
  for (Point2<Map>* p : {&real[0].segment.a, &real[0].segment.b}) p->y_m += 0.3;
  std::mt19937 engine(5);
  for (const double y : {-2.0, 3.0}) {  // from either side
    const Transform2<Map, Base> pose(3.0, y, 0.7);
    const auto scan = surfaces(test::simulate_scan(real, pose, test::full_turn(720, 30.0), engine));
    const Eigen::Matrix3d covariance = Eigen::Vector3d(0.25, 0.01, 0.0).asDiagonal();
    const auto looks = wall_looks(cells, WallIndex(walls), scan, pose, covariance);
    ASSERT_FALSE(looks.empty());
    for (const WallLook& look : looks) {
      EXPECT_NEAR(look.offset_m, 0.3, 1e-3);
      EXPECT_NEAR(look.sigma_m, std::hypot(0.02, 0.1), 1e-6);  // across the wall only y counts
    }
  }
}

/// A column half a metre wide, drawn a hand's breadth beside where it stands: beams that pass beside it are
/// not beams through it, or it would never be believed to be there.
TEST(WallLooks, WhatPassesBesideAColumnDoesNotPassThroughIt) {
  const mapping::Walls drawn{{1, {{8.0, -0.25}, {8.0, 0.25}}}, {2, {{12.0, -4.0}, {12.0, 4.0}}}};
  constexpr double kBesideM = 0.12;
  std::vector<Point2<Base>> points;
  for (double bearing = -0.3; bearing < 0.3; bearing += 0.003) {
    const double y = 8.0 * std::tan(bearing);
    const double x = y > -0.25 + kBesideM && y < 0.25 + kBesideM ? 8.0 : 12.0;
    points.push_back({x, x * std::tan(bearing)});
  }
  const WallCells cells(drawn);
  const auto looks = wall_looks(cells, WallIndex(drawn), make_surface_scan({}, {}, points), {0.0, 0.0, 0.0},
                                sure({}).covariance);
  const auto column = std::ranges::find(looks, 0U, &WallLook::cell);
  ASSERT_NE(column, looks.end());
  EXPECT_GT(column->ended, 5);
  EXPECT_EQ(column->passed, 0);
}

TEST(WallReliability, TellsConfirmedMissingAndDisplacedWalls) {
  const mapping::Walls drawing = test::laboratory_hall();
  WallReliability reliability(drawing);
  learn(reliability, round_trip(building(), 6));
  int wrong = 0;
  int told = 0;
  for (std::size_t c = 0; c < reliability.cells().size(); ++c) {
    const std::size_t wall = reliability.cells().all()[c].wall;
    const WallState expected = wall == kScreen     ? WallState::Missing
                               : wall == kEastWall ? WallState::Displaced
                                                   : WallState::Confirmed;
    if (reliability.state(c) == WallState::Unseen) continue;
    ++told;
    wrong += reliability.state(c) != expected;
    if (expected == WallState::Displaced && reliability.state(c) == expected) {
      // a -> b runs up, so left is inwards
      EXPECT_NEAR(reliability.beliefs()[c].offset_m, kMovedM, 0.03);
    }
  }
  EXPECT_GT(told, 60);
  EXPECT_LE(wrong, told / 50) << wrong << " of " << told;
}

TEST(WallReliability, StandingStillTeachesOnce) {
  const mapping::Walls drawing = test::laboratory_hall();
  const auto moments = round_trip(drawing, 7);
  WallReliability once(drawing);
  WallReliability standing(drawing);
  once.observe(surfaces(moments.front().scan), sure(moments.front().truth));
  for (int i = 0; i < 500; ++i) {  // turning to and fro on the spot as well
    const Transform2<Map, Base>& p = moments.front().truth;
    standing.observe(surfaces(moments.front().scan),
                     sure({p.x_m(), p.y_m(), p.yaw_rad() + 1e-3 * (i % 300)}));
  }
  for (std::size_t c = 0; c < once.beliefs().size(); ++c) EXPECT_LE(standing.beliefs()[c].looks(), 1.0);
  double looks = 0.0;
  for (const WallBelief& b : once.beliefs()) looks += b.looks();
  EXPECT_GT(looks, 10.0);
}

TEST(WallReliability, NothingIsLearnedWhileThePlaceIsInDoubt) {
  const mapping::Walls drawing = test::laboratory_hall();
  WallReliability reliability(drawing);
  for (const auto& m : round_trip(drawing, 8)) {
    PoseEstimate pose = sure(m.truth);
    pose.health.state = LocalizationState::Degraded;
    if (m.has_scan) reliability.observe(surfaces(m.scan), pose);
  }
  for (const WallBelief& b : reliability.beliefs()) EXPECT_EQ(b.looks(), 0.0);
}

TEST(WallReliability, AWallThatIsTornDownIsUnlearned) {
  const mapping::Walls drawing = test::laboratory_hall();
  WallReliability reliability(drawing);
  learn(reliability, round_trip(drawing, 9));
  const std::size_t middle = reliability.cells().first(kScreen);
  ASSERT_EQ(reliability.state(middle), WallState::Confirmed);
  for (unsigned day = 0; day < 4; ++day) learn(reliability, round_trip(building(), 10 + day));
  EXPECT_EQ(reliability.state(middle), WallState::Missing);
  EXPECT_LE(reliability.beliefs()[middle].looks(), reliability.options().most_looks + 1e-9);
}

TEST(WallWeights, LeaveOutWhatIsGoneAndMoveWhatStandsElsewhere) {
  const mapping::Walls drawing = test::laboratory_hall();
  WallReliability reliability(drawing);
  const WallWeights before = wall_weights(drawing, reliability);
  EXPECT_EQ(before.walls, drawing);
  learn(reliability, round_trip(building(), 6));
  learn(reliability, round_trip(building(), 16));
  const WallWeights after = wall_weights(drawing, reliability);
  ASSERT_EQ(after.walls.size(), after.weights.size());
  double moved_m = 0.0;
  for (const mapping::Wall& wall : after.walls) {
    EXPECT_NE(wall.id, drawing[kScreen].id);
    if (wall.id == drawing[kEastWall].id && std::abs(wall.segment.a.x_m - 20.0 + kMovedM) < 0.04)
      moved_m += wall.segment.length_m();
  }
  EXPECT_GT(moved_m, 4.0);
}

TEST(ReliabilityFile, KeepsWhatWasLearnedAndDiscardsWhatBelongsToOtherWalls) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "reliability.csv";
  const mapping::Walls drawing = test::laboratory_hall();
  WallReliability learned(drawing);
  EXPECT_EQ(load_reliability(file, learned), "");  // no file yet
  learn(learned, round_trip(building(), 6));
  save_reliability(file, learned);
  WallReliability again(drawing);
  EXPECT_EQ(load_reliability(file, again), "");
  for (std::size_t c = 0; c < learned.cells().size(); ++c) EXPECT_EQ(again.state(c), learned.state(c));
  EXPECT_EQ(reliability_csv(again), reliability_csv(learned));
  mapping::Walls changed = drawing;
  for (mapping::Wall& wall : changed)  // scaled by a percent
    for (Point2<Map>* end : {&wall.segment.a, &wall.segment.b}) *end = {1.01 * end->x_m, 1.01 * end->y_m};
  WallReliability other(changed);
  EXPECT_NE(load_reliability(file, other).find("walls have changed"), std::string::npos);
  for (const WallBelief& b : other.beliefs()) EXPECT_EQ(b.looks(), 0.0);
  folder.write("reliability.csv", reliability_csv(learned).substr(0, 500));
  EXPECT_NE(load_reliability(file, again).find("learned anew"), std::string::npos);
}

/// Two pieces taken out of a wall of ten, which becomes two walls with other numbers: all other pieces keep
/// what was learned of them.
TEST(ReliabilityFile, AWallThatIsTakenOutLeavesTheOthersAsTheyWere) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "reliability.csv";
  mapping::Walls drawing{{1, {{0.0, 0.0}, {10.4, 0.0}}}, {2, {{0.0, 5.0}, {7.0, 5.0}}}};
  WallReliability learned(drawing);
  std::vector<WallBelief> beliefs(learned.cells().size());
  for (std::size_t i = 0; i < beliefs.size(); ++i) beliefs[i].in_place = 1.0 + static_cast<double>(i);
  learned.set_beliefs(beliefs);
  save_reliability(file, learned);
  drawing = {{1, {{0.0, 5.0}, {7.0, 5.0}}}, {2, {{0.0, 0.0}, {3.12, 0.0}}}, {3, {{5.2, 0.0}, {10.4, 0.0}}}};
  WallReliability left(drawing);
  EXPECT_EQ(load_reliability(file, left), "");
  std::vector<double> looks;
  for (const WallBelief& b : left.beliefs()) looks.push_back(b.in_place);
  EXPECT_EQ(looks, (std::vector<double>{11, 12, 13, 14, 15, 16, 17, 1, 2, 3, 6, 7, 8, 9, 10}));
}

}  // namespace
}  // namespace madori::localization
