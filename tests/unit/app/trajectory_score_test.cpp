#include "app/trajectory_score.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "core/result.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::app {
namespace {

using nlohmann::json;
using test::TemporaryFolder;

std::vector<StampedPose> wander(std::mt19937& engine, int count, double interval_s) {
  std::normal_distribution<double> noise;
  std::vector<StampedPose> poses;
  Transform2<Map, Base> at;
  for (int i = 0; i < count; ++i) {
    poses.push_back({stamp_from_seconds(100.0 + i * interval_s), at});
    at = at * Transform2<Base, Base>(interval_s, 0.0, 0.2 * interval_s * noise(engine));
  }
  return poses;
}

std::vector<StampedPose> disturbed(std::vector<StampedPose> poses, std::mt19937& engine) {
  std::normal_distribution<double> noise;
  for (auto& [stamp, pose] : poses) {
    pose = {pose.x_m() + 0.3 * noise(engine), pose.y_m() + 0.3 * noise(engine),
            pose.yaw_rad() + 0.1 * noise(engine)};
  }
  return poses;
}

std::string tum(const std::vector<StampedPose>& poses) {
  std::string text;
  for (const auto& [stamp, pose] : poses) text += tum_line(stamp, pose);
  return text;
}

TEST(TrajectoryScore, ATrajectoryScoresPerfectlyAgainstItself) {
  std::mt19937 engine(1);
  const auto poses = wander(engine, 100, 0.5);
  const json score = score_against_truth(poses, poses);
  EXPECT_NEAR(score["position_m"]["max"].get<double>(), 0.0, 1e-9);
  EXPECT_EQ(score["matched"], 100);
  EXPECT_EQ(score["within"]["share"], 1.0);
}

TEST(TrajectoryScore, NothingToScoreIsRefused) {
  std::mt19937 engine(1);
  const auto poses = wander(engine, 10, 0.5);
  EXPECT_THROW((void)score_against_truth({}, poses), Error);
  EXPECT_THROW((void)score_against_truth(poses, {}), Error);
  EXPECT_THROW((void)score_against_relations({}, {{poses.front().stamp, poses.back().stamp, {}}}), Error);
}

TEST(TrajectoryScore, AKnownOffsetIsItsError) {
  std::mt19937 engine(2);
  const auto truth = wander(engine, 50, 1.0);
  auto shifted = truth;
  for (auto& [stamp, pose] : shifted)
    pose = {pose.x_m() + 0.3, pose.y_m() - 0.4, pose.yaw_rad() + to_rad(5.0)};
  const json score = score_against_truth(shifted, truth);
  EXPECT_NEAR(score["position_m"]["median"].get<double>(), 0.5, 1e-9);
  EXPECT_NEAR(score["heading_deg"]["mean"].get<double>(), 5.0, 1e-9);
}

TEST(TrajectoryScore, NothingMatchedIsAnError) {
  std::mt19937 engine(3);
  auto late = wander(engine, 10, 1.0);
  const auto truth = late;
  for (auto& pose : late) pose.stamp += std::chrono::hours(1);
  EXPECT_THROW((void)score_against_truth(late, truth), Error);
  EXPECT_THROW((void)score_against_relations(late, {{truth[0].stamp, truth[3].stamp, {}}}), Error);
}

/// The figures of the outside script on the same files.
json outside(const TemporaryFolder& folder, const std::string& options) {
  const std::filesystem::path out = folder.path() / "outside.json";
  const std::string script = std::string(MADORI_SHARED_DATA) + "/../score/trajectory.py";
  const std::string command = "/usr/bin/python3 " + script + " --estimate " +
                              (folder.path() / "e.tum").string() + options + " --json " + out.string() +
                              " > /dev/null";
  if (std::system(command.c_str()) != 0) return {};  // NOLINT(cert-env33-c,concurrency-mt-unsafe)
  std::ifstream stream(out);
  return json::parse(stream);
}

TEST(TrajectoryScore, AgreesWithTheOutsideScript) {
  if (!std::filesystem::exists(std::string(MADORI_SHARED_DATA) + "/../score/trajectory.py")) {
    GTEST_SKIP() << "no outside scorer at " << MADORI_SHARED_DATA << "/../score";
  }
  std::mt19937 engine(4);
  const auto truth = wander(engine, 80, 1.0);
  auto estimate = disturbed(wander(engine, 330, 0.23), engine);
  std::swap(estimate[40], estimate[41]);  // out of time order, as in real logs
  const TemporaryFolder folder;
  folder.write("e.tum", tum(estimate));
  folder.write("t.tum", tum(truth));
  std::string relations;
  for (int i = 0; i + 9 < 80; i += 3) {
    relations += std::to_string(100 + i) + " " + std::to_string(109 + i) + " 8.5 0.1 0 0 0 0.05\n";
  }
  folder.write("r.relations", relations);
  const json theirs = outside(folder, " --reference " + (folder.path() / "t.tum").string());
  const json ours = score_against_truth(load_tum(folder.path() / "e.tum"), load_tum(folder.path() / "t.tum"));
  ASSERT_FALSE(theirs.is_null());
  for (const char* key : {"mean", "median", "rmse", "p95", "max"}) {
    EXPECT_NEAR(ours["position_m"][key].get<double>(), theirs["position_m"][key].get<double>(), 1e-6) << key;
  }
  EXPECT_NEAR(ours["heading_deg"]["p95"].get<double>(), theirs["heading_deg"]["p95"].get<double>(), 1e-5);
  EXPECT_EQ(ours["matched"], theirs["matched"]);
  EXPECT_NEAR(ours["within"]["share"].get<double>(), theirs["within"]["share"].get<double>(), 1e-9);
  const json their_pairs = outside(folder, " --relations " + (folder.path() / "r.relations").string());
  const json our_pairs = score_against_relations(load_tum(folder.path() / "e.tum"),
                                                 load_relations(folder.path() / "r.relations"));
  EXPECT_EQ(our_pairs["matched"], their_pairs["matched"]);
  for (const char* key : {"translation_m", "translation_m2", "rotation_deg", "rotation_deg2"}) {
    EXPECT_NEAR(our_pairs[key]["mean"].get<double>(), their_pairs[key]["mean"].get<double>(), 1e-5) << key;
    EXPECT_NEAR(our_pairs[key]["std"].get<double>(), their_pairs[key]["std"].get<double>(), 1e-5) << key;
  }
}

TEST(TrajectoryFile, ADamagedLineIsNamed) {
  const TemporaryFolder folder;
  folder.write("a.tum", "# comment\n1 2 3 0 0 0 0 1\n2 2 3 0 0 0 0.5 0.5\n");
  try {
    (void)load_tum(folder.path() / "a.tum");
    FAIL() << "a quaternion of wrong length was accepted";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("a.tum:3"), std::string::npos) << e.what();
  }
  folder.write("b.tum", "1 2 3\n");
  EXPECT_THROW((void)load_tum(folder.path() / "b.tum"), Error);
  folder.write("c.tum", "1 2 nan 0 0 0 0 1\n");
  EXPECT_THROW((void)load_tum(folder.path() / "c.tum"), Error);
}

TEST(TrajectoryFile, KeepsTimesBefore1970) {
  const test::TemporaryFolder folder;
  std::string text;
  for (const double time_s : {-20.5, -0.25, 0.0, 20.5}) text += tum_line(stamp_from_seconds(time_s), {});
  const auto poses = load_tum(folder.write("a.tum", text));
  ASSERT_EQ(poses.size(), 4U);
  EXPECT_DOUBLE_EQ(to_seconds(poses[0].stamp), -20.5);
  EXPECT_DOUBLE_EQ(to_seconds(poses[1].stamp), -0.25);
  EXPECT_DOUBLE_EQ(to_seconds(poses[3].stamp), 20.5);
}

}  // namespace
}  // namespace madori::app
