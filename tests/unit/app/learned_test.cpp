#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "app/learned/calibration_file.hpp"
#include "app/learned/learned_drawing.hpp"
#include "app/learned/wall_watch.hpp"
#include "app/plot/localizability_plot.hpp"
#include "app/plot/reliability_plot.hpp"
#include "core/result.hpp"
#include "localization/scan_points.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/made_up_drive.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::app {
namespace {

localization::SelfCalibration found(double x, double y, double sigma) {
  localization::SelfCalibration c;
  c.strain = {x, y, 0.001};
  c.covariance = Eigen::Vector3d(sigma * sigma, 4.0 * sigma * sigma, 1e-8).asDiagonal();
  c.covariance(0, 1) = c.covariance(1, 0) = 0.5 * sigma * sigma;
  c.converged = true;
  c.walls = 40;
  c.keyframes = 120;
  return c;
}

TEST(CalibrationFile, ComesBackAndBelongsToItsWalls) {
  const test::TemporaryFolder folder;
  const mapping::Walls walls = test::laboratory_hall();
  EXPECT_THROW((void)load_calibration(folder.path(), walls), Error) << "never measured";
  ASSERT_TRUE(keep_calibration(folder.path(), walls, found(0.0102, 0.0098, 5e-4)));
  const auto back = load_calibration(folder.path(), walls);
  EXPECT_TRUE(back.strain.isApprox(Eigen::Vector3d(0.0102, 0.0098, 0.001), 1e-6));
  EXPECT_TRUE(back.covariance.isApprox(found(0.0, 0.0, 5e-4).covariance, 1e-6));
  EXPECT_EQ(back.walls, 40);
  mapping::Walls changed = walls;
  changed[0].segment.a.x_m += 0.001;
  EXPECT_THROW((void)load_calibration(folder.path(), changed), Error);
  folder.write(kCalibrationFile, "strain_x: many");
  EXPECT_THROW((void)load_calibration(folder.path(), walls), Error);
}

TEST(CalibrationFile, TheMoreCertainOneStays) {
  const test::TemporaryFolder folder;
  const mapping::Walls walls = test::laboratory_hall();
  EXPECT_FALSE(keep_calibration(folder.path(), walls, found(0.02, 0.02, 0.03))) << "worth nothing";
  EXPECT_TRUE(keep_calibration(folder.path(), walls, found(0.010, 0.010, 5e-4)));
  EXPECT_FALSE(keep_calibration(folder.path(), walls, found(0.011, 0.010, 8e-4)));
  EXPECT_TRUE(keep_calibration(folder.path(), walls, found(0.012, 0.010, 4e-4)));
  EXPECT_NEAR(load_calibration(folder.path(), walls).strain[0], 0.012, 1e-9);
}

TEST(SelfCalibrationScale, IsTheBestSingleScaleAndRefusedWhereUncertain) {
  mapping::ScaleRecord now;
  now.m_per_px = 0.05;
  auto even = found(0.01, 0.01, 3e-4);
  even.strain[2] = 0.0;
  const auto good = scale_of(even, now);
  EXPECT_NEAR(good.m_per_px, 0.05 / 1.01, 1e-9) << "too large a drawing gets smaller";
  EXPECT_EQ(good.verdict, mapping::Verdict::Good);
  EXPECT_FALSE(good.stretch);
  const auto stretched = scale_of(found(0.015, 0.001, 3e-4), now);
  ASSERT_TRUE(stretched.stretch);
  EXPECT_NEAR(*stretched.stretch, 1.001 / 1.015 - 1.0, 1e-9);
  EXPECT_EQ(stretched.verdict, mapping::Verdict::Usable);
  EXPECT_EQ(scale_of(found(0.01, 0.01, 6e-3), now).verdict, mapping::Verdict::Refused);
}

TEST(SelfCalibrationScale, IsToldInWords) {
  const std::string text = describe(found(0.0102, -0.004, 5e-4));
  EXPECT_NE(text.find("1.02 % +- 0.05 % too large along x"), std::string::npos) << text;
  EXPECT_NE(text.find("0.40 % +- 0.10 % too small along y"), std::string::npos) << text;
}

TEST(LearnedDrawing, WithoutAFileTheDrawingIsAsItIs) {
  const test::TemporaryFolder folder;
  const mapping::Walls walls = test::laboratory_hall();
  const LearnedDrawing fresh = load_learned_drawing(folder.path(), walls);
  EXPECT_EQ(fresh.drawing.walls, walls);
  EXPECT_TRUE(fresh.messages.empty());
  folder.write(kReliabilityFile, "no table");
  const LearnedDrawing damaged = load_learned_drawing(folder.path(), walls);
  EXPECT_EQ(damaged.drawing.walls, walls);
  ASSERT_EQ(damaged.messages.size(), 1U);
}

TEST(Pictures, TellWhatTheyShow) {
  const mapping::Walls walls = test::laboratory_hall();
  const localization::WallReliability nothing(walls);
  EXPECT_GT(reliability_plot(walls, nothing).size(), 2000U);
  double all_m = 0.0;
  for (const auto& wall : walls) all_m += wall.segment.length_m();
  EXPECT_NEAR(to_json(nothing).at("unseen_m").get<double>(), all_m, 1e-6);
}

TEST(LocalizabilityMap, MarksABareCorridorAndNotARoom) {
  mapping::Walls corridor;
  test::add_wall(corridor, 0.0, 0.0, 90.0, 0.0);
  test::add_wall(corridor, 0.0, 3.0, 90.0, 3.0);
  test::add_wall(corridor, 90.0, 0.0, 90.0, 3.0);
  Path path;
  for (int i = 0; i < 80; ++i) path.points.push_back({{5.0 + i, 1.5}, 0.0, 0.0});
  const auto map = forecast_localizability(corridor, std::vector<double>(3, 1.0), path);
  EXPECT_EQ(fix_of(map.route[20]), Fix::Bare);  // 65 m from the end, beyond the lidar's 30 m
  EXPECT_NE(fix_of(map.route.back()), Fix::Bare);
  EXPECT_NEAR(to_json(map).at("bare_m").get<double>(), 55.0, 3.0);
  EXPECT_NE(describe(map).find("are bare"), std::string::npos);
  mapping::Walls room;
  test::add_box(room, 0.0, 0.0, 8.0, 8.0);
  const auto square = forecast_localizability(room, std::vector<double>(4, 1.0), {{{{4.0, 4.0}, 0.0, 0.0}}});
  const auto& c = square.route.front().covariance;
  EXPECT_NEAR(c(0, 0), c(1, 1), 0.02 * c(0, 0));  // the same in all directions
  EXPECT_NEAR(c(0, 1), 0.0, 0.02 * c(0, 0));
  EXPECT_GT(square.floor.size(), 40U);
  for (const auto& place : square.floor) EXPECT_NE(fix_of(place), Fix::Bare);
}

/// One scan after the other, each looked at before the next comes.
void drive_past(WallWatch& watch, const mapping::Walls& building, LocalizationState state) {
  std::mt19937 engine(3);
  test::DriveSettings settings;
  settings.lidar = test::full_turn(540, 30.0);
  for (const auto& m : test::drive(building, {{2.0, 1.2}, {14.5, 1.0}, {14.0, 8.0}, {7.2, 7.6}, {6.8, 1.3}},
                                   settings, engine)) {
    if (!m.has_scan) continue;
    const auto before = watch.looks();
    const bool taken =
        watch.see(localization::scan_points(m.scan, {}),
                  {m.scan.stamp, m.truth, Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal(), {state, ""}});
    while (taken && watch.looks() == before) std::this_thread::yield();
  }
}

std::size_t count_of(const std::vector<SeenWall>& seen, localization::WallState state) {
  return static_cast<std::size_t>(std::ranges::count(seen, state, &SeenWall::state));
}

TEST(WallWatch, ConfirmsWhatStandsAndMissesWhatWasTornDown) {
  const test::TemporaryFolder folder;
  const mapping::Walls drawn = test::laboratory_hall();
  mapping::Walls building = drawn;
  building.erase(building.begin() + 30);  // the screen at x = 11
  WallWatch watch(drawn, {0.0, 0.0}, folder.path() / kReliabilityFile);
  EXPECT_EQ(count_of(watch.seen(), localization::WallState::Unseen), watch.seen().size());
  drive_past(watch, building, LocalizationState::Localized);
  EXPECT_GT(count_of(watch.seen(), localization::WallState::Confirmed), 30U);
  for (const auto& piece : watch.seen()) {
    if (piece.state != localization::WallState::Missing) continue;
    EXPECT_EQ(piece.cell.wall_id, drawn[30].id);
    EXPECT_LT(piece.share_in_place, 0.5);
  }
  EXPECT_GT(count_of(watch.seen(), localization::WallState::Missing), 0U);
}

TEST(WallWatch, LearnsNothingWhileThePlaceIsNotSure) {
  const mapping::Walls drawn = test::laboratory_hall();
  WallWatch watch(drawn, {0.0, 0.0}, "no such file");
  drive_past(watch, drawn, LocalizationState::Degraded);
  EXPECT_EQ(watch.looks(), 0U);
  EXPECT_EQ(count_of(watch.seen(), localization::WallState::Unseen), watch.seen().size());
}

}  // namespace
}  // namespace madori::app
