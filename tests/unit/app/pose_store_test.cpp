#include "app/pose/pose_store.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <utility>

#include "app/cycle/cycle.hpp"
#include "app/keeping/site_keeper.hpp"
#include "app/learned/learned_drawing.hpp"
#include "app/pose/localizer_pose.hpp"
#include "app/recording/input_text.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/wall_map/wall_fingerprint.hpp"
#include "tests/support/lidar_models.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/toy_lidar.hpp"

namespace madori::app {
namespace {

constexpr double kTopM = 4.0;
constexpr double kHalfWidthM = 0.05;

/// A hall that looks the same from both ends, so that one scan alone cannot tell the place; with a block in
/// one corner it can.
std::vector<test::LyingBody> hall(bool block) {
  const auto wall = [](double x1, double y1, double x2, double y2) {
    return test::LyingBody{{{x1, y1}, {x2, y2}}, kHalfWidthM, kTopM};
  };
  std::vector<test::LyingBody> walls{wall(0, 0, 14, 0), wall(14, 0, 14, 8), wall(14, 8, 0, 8),
                                     wall(0, 8, 0, 0)};
  if (block) {
    walls.push_back(wall(9.0, 5.5, 11.5, 5.5));
    walls.push_back(wall(3.0, 1.8, 3.0, 3.0));
  }
  return walls;
}

mapping::Walls drawing(const std::vector<test::LyingBody>& bodies) {
  mapping::Walls walls;
  for (const test::LyingBody& body : bodies)
    for (const auto& edge : body.edges()) walls.push_back({static_cast<int>(walls.size()), edge});
  return walls;
}

control::wire::Status status_at(std::uint16_t sequence, const WheelCounters& wheels) {
  control::wire::Status status;
  status.sequence = sequence;
  status.time_us = 20'000U * sequence;
  status.left_angle = wheels.left_angle;
  status.right_angle = wheels.right_angle;
  status.left_turns = wheels.left_turns;
  status.right_turns = wheels.right_turns;
  return status;
}

const WheelCounters kWheels{1000, 16000, 12, -3};

/// A vehicle that has just been switched on at `truth` and stands; what it came to after two seconds.
struct Start {
  PoseEstimate pose;
  int clouds = 0;  ///< until it was localized; -1: never
  std::string verdict;
  std::vector<PoseHypothesis> places;  ///< where it may be
};

Start switch_on(bool block, const Transform2<Map, Base>& truth, const std::optional<StoredPose>& stored,
                const WheelCounters& wheels) {
  test::ToyLidar lidar;
  lidar.bodies = hall(block);
  CycleConfig config;
  config.lidars = {test::spinning_lidar({0.0, 0.0, lidar.height_m, 0.0})};
  CycleState state(config, std::make_unique<LocalizerPose>(drawing(lidar.bodies), config.lidars));
  std::mt19937 random(3);
  Start result{{}, -1, "", {}};
  PoseRecall recall(stored);
  std::optional<OperatorCommand> word;
  int clouds = 0;
  for (std::uint16_t i = 0; i < 110; ++i) {
    CycleInput input;
    input.now = stamp_from_seconds(2000.0 + 0.02 * i);
    if (const auto said = std::exchange(word, std::nullopt)) input.commands.push_back(*said);
    input.drive.push_back(status_at(i, wheels));
    if (i % 5 == 4) {
      const PointCloud<Base> seen = lidar.scan(truth, input.now, random);
      input.clouds.push_back({seen.stamp, seen.points});
      for (CloudPoint& p : input.clouds.back().points) p.z_m -= static_cast<float>(lidar.height_m);
      ++clouds;
    }
    StepResult done = step(std::move(state), input, config);
    state = std::move(done.state);
    if (const auto said = recall.on_status(state.drive)) word = said;
    if (result.clouds < 0 && state.pose.health.state == LocalizationState::Localized) result.clouds = clouds;
  }
  result.pose = state.pose;
  result.verdict = recall.verdict();
  result.places = state.localization->hypotheses();
  return result;
}

StoredPose stored_at(const Transform2<Map, Base>& pose) {
  return {stamp_from_seconds(1900.0), pose, Eigen::Matrix3d::Identity() * 1e-3, kWheels, "walls"};
}

TEST(PoseStore, ComesBackFromItsFile) {
  const test::TemporaryFolder folder;
  StoredPose pose = stored_at({12.345678, -3.25, 1.234567});
  pose.covariance(0, 1) = pose.covariance(1, 0) = -2.5e-4;
  folder.write(kPoseFile, stored_pose_yaml(pose));
  const LoadedPose back = load_stored_pose(folder.path(), "walls");
  ASSERT_TRUE(back.pose) << back.message;
  EXPECT_NEAR(back.pose->map_from_base.x_m(), 12.345678, 1e-6);
  EXPECT_NEAR(back.pose->map_from_base.yaw_rad(), 1.234567, 1e-7);
  EXPECT_NEAR(back.pose->covariance(1, 0), -2.5e-4, 1e-9);
  EXPECT_EQ(back.pose->wheels, kWheels);
  EXPECT_EQ(back.pose->stamp, pose.stamp);
}

TEST(PoseStore, ADamagedFileOrAnotherDrawingIsSaidAndNotUsed) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(load_stored_pose(folder.path(), "walls").message, "");  // never stored: nothing to say
  const std::string good = stored_pose_yaml(stored_at({1.0, 2.0, 0.0}));
  for (const std::string& text : {std::string("x_m: 1"), good.substr(0, good.size() / 2),
                                  std::string("\x01\x02"), good + "unknown: 1\n", std::string()}) {
    folder.write(kPoseFile, text);
    const LoadedPose loaded = load_stored_pose(folder.path(), "walls");
    EXPECT_FALSE(loaded.pose) << text;
    EXPECT_NE(loaded.message.find("looked for on the whole drawing"), std::string::npos) << text;
  }
  folder.write(kPoseFile, good);
  EXPECT_NE(load_stored_pose(folder.path(), "others").message.find("drawing has changed"), std::string::npos);
}

TEST(PoseStore, CountersTellWhetherAWheelHasTurned) {
  EXPECT_TRUE(same_place(kWheels, {1010, 15990, 12, -3}));
  EXPECT_FALSE(same_place(kWheels, {1200, 16000, 12, -3}));
  EXPECT_FALSE(same_place(kWheels, {1000, 16000, 13, -3}));
  EXPECT_TRUE(same_place({16380, 0, 4, 0}, {4, 0, 5, 0})) << "over the end of a turn";
}

TEST(PoseStore, WhereNothingMovedThePlaceIsKnownAtOnce) {
  const Transform2<Map, Base> truth(4.0, 3.0, 0.4);
  const Start alone = switch_on(false, truth, std::nullopt, kWheels);
  EXPECT_EQ(alone.clouds, -1) << "the hall looks the same from both ends";
  const Start kept = switch_on(false, truth, stored_at(truth), kWheels);
  EXPECT_GT(kept.clouds, 0);
  EXPECT_LE(kept.clouds, 5) << "after the first look, 0.3 s";
  EXPECT_LT(distance_m(kept.pose.map_from_base.translation(), truth.translation()), 0.05);
  EXPECT_NE(kept.verdict.find("nothing has moved"), std::string::npos);
}

TEST(PoseStore, WhereTheWheelsHaveTurnedThePlaceIsSoughtAnew) {
  const Transform2<Map, Base> truth(4.0, 3.0, 0.4);
  const Start rolled = switch_on(false, truth, stored_at(truth), {1000, 16000, 13, -3});
  EXPECT_EQ(rolled.clouds, -1) << "the stored place must not be taken";
  EXPECT_NE(rolled.verdict.find("wheels have turned"), std::string::npos);
}

/// The stored place and what is seen contradict each other: neither is believed at once, both are named.
TEST(PoseStore, AVehicleCarriedElsewhereNamesItsTruePlace) {
  const Transform2<Map, Base> truth(6.0, 3.5, -0.6);
  const Start carried = switch_on(true, truth, stored_at({4.0, 3.0, 0.4}), kWheels);
  EXPECT_EQ(carried.clouds, -1) << "believed at " << carried.pose.map_from_base.x_m();
  EXPECT_TRUE(std::any_of(carried.places.begin(), carried.places.end(), [&](const PoseHypothesis& place) {
    return place.probability > 0.05 &&
           distance_m(place.map_from_base.translation(), truth.translation()) < 0.1;
  }));
}

TEST(PoseStore, TheRecordedInputHoldsItToTheLastBit) {
  const StoredPose pose = stored_at({1.0 / 3.0, 2.0 / 7.0, 0.1});
  PoseRecall recall(pose);
  CycleInput input;
  const auto word = recall.on_status(status_at(1, kWheels));
  ASSERT_TRUE(word);
  input.commands.push_back(*word);
  const auto back = input_from_text(input_text(input)).commands;
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].given_pose, word->given_pose);
  EXPECT_EQ(back[0].given_pose.position.x_m, 1.0 / 3.0);
  EXPECT_FALSE(recall.on_status(status_at(2, kWheels))) << "said once";
}

TEST(SiteKeeper, KeepsThePoseAtMostEverySecondAndAtAStandstill) {
  const test::TemporaryFolder folder;
  const mapping::Walls walls = drawing(hall(true));
  SiteKeeper keeper(SiteKeeper::Learned(folder.path()), walls, nullptr);
  CycleState state(CycleConfig{}, std::make_unique<LocalizerPose>(
                                      walls, std::vector{test::spinning_lidar({0.0, 0.0, 1.2, 0.0})}));
  state.pose.health = {LocalizationState::Localized, ""};
  const auto at = [&](double t, double x, std::uint16_t angle) {
    state.drive_heard = stamp_from_seconds(3000.0 + t);
    state.drive.left_angle = state.drive.right_angle = angle;
    state.pose.map_from_base = {x, 1.0, 0.0};
    keeper.observe(state, *state.drive_heard);
    keeper.flush();
    const auto loaded = load_stored_pose(folder.path(), mapping::walls_fingerprint(walls));
    return loaded.pose ? loaded.pose->map_from_base.x_m() : -1.0;
  };
  EXPECT_EQ(at(0.0, 1.0, 100), 1.0);
  EXPECT_EQ(at(0.4, 2.0, 600), 1.0) << "less than a second later";
  EXPECT_EQ(at(1.1, 3.0, 1200), 3.0);
  EXPECT_EQ(at(1.5, 4.0, 1900), 3.0);
  EXPECT_EQ(at(1.6, 4.1, 1900), 4.1) << "it stands";
  state.pose.health.state = LocalizationState::Degraded;
  EXPECT_EQ(at(3.0, 5.0, 2900), 4.1) << "in doubt";
  state.pose.health.state = LocalizationState::Lost;
  EXPECT_EQ(at(5.0, 5.0, 2900), -1.0) << "lost: no pose is better than a wrong one";
}

TEST(SiteKeeper, SaysWhatIsNotKeptUntilItIs) {
  const test::TemporaryFolder folder;
  const mapping::Walls walls = drawing(hall(true));
  const auto site = folder.path() / "site";
  SiteKeeper keeper(SiteKeeper::Learned(site), walls, nullptr);  // as on a disk that is gone
  CycleState state(CycleConfig{}, std::make_unique<LocalizerPose>(
                                      walls, std::vector{test::spinning_lidar({0.0, 0.0, 1.2, 0.0})}));
  state.pose.health = {LocalizationState::Localized, ""};
  const auto problem_at = [&](double t) {
    state.drive_heard = stamp_from_seconds(3000.0 + t);
    state.drive.left_angle = static_cast<std::uint16_t>(100.0 * t);
    keeper.observe(state, *state.drive_heard);
    keeper.flush();
    return keeper.problem();
  };
  EXPECT_NE(problem_at(0.0).find("last_pose.yaml"), std::string::npos);
  EXPECT_NE(problem_at(0.5), "") << "nothing was tried since";
  std::filesystem::create_directory(site);
  EXPECT_EQ(problem_at(2.0), "");
}

TEST(SiteKeeper, LeavesWhatSomebodyElseHasPutInItsPlace) {
  const test::TemporaryFolder folder;
  const mapping::Walls walls = drawing(hall(true));
  const auto file = folder.path() / kReliabilityFile;
  const auto watch = [&] { return std::make_shared<WallWatch>(walls, Point2<Base>{}, file); };
  { const SiteKeeper keeper(SiteKeeper::Learned(folder.path()), walls, watch()); }
  const std::string kept = mapping::file_content(file);
  EXPECT_FALSE(kept.empty());
  {
    const SiteKeeper keeper(SiteKeeper::Learned(folder.path()), walls, watch());
    mapping::write_file_atomically(file, std::string_view("a backup's"));
  }
  EXPECT_EQ(mapping::file_content(file), "a backup's");
  {
    const SiteKeeper keeper(SiteKeeper::Learned(folder.path()), walls, watch());
    std::filesystem::remove(file);
  }
  EXPECT_FALSE(std::filesystem::exists(file)) << "forgotten on purpose";
  {
    SiteKeeper keeper(SiteKeeper::Learned(folder.path()), walls, watch());
    keeper.finish_learning();
    keeper.flush();
    EXPECT_EQ(mapping::file_content(file), kept);
    std::filesystem::remove(file);
  }
  EXPECT_FALSE(std::filesystem::exists(file)) << "nothing is learned after the end";
}

}  // namespace
}  // namespace madori::app
