#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/log_player.hpp"
#include "app/trajectory_score.hpp"
#include "mapping/drawing/read_drawing.hpp"
#include "mapping/picture/load_image.hpp"
#include "sensors/carmen/reader.hpp"
#include "tests/support/lidar_models.hpp"

namespace madori::app {
namespace {

constexpr double kScale = 0.04259;
const std::filesystem::path kIntel = std::filesystem::path(MADORI_SHARED_DATA) / "lidar2d/intel";

mapping::Walls drawn_walls(const char* file) {
  const mapping::GrayImage image = mapping::load_image(kIntel / file);
  const mapping::DetectedWalls found = mapping::read_drawing(image, {});
  mapping::Walls walls;
  for (const mapping::PixelSegment& s : found.walls) {
    walls.push_back({static_cast<int>(walls.size()),
                     {{s.u1 * kScale, (image.height_px - s.v1) * kScale},
                      {s.u2 * kScale, (image.height_px - s.v2) * kScale}},
                     found.probabilities[walls.size()]});
  }
  return walls;
}

struct LocalizedRun {
  std::vector<StampedPose> trajectory;
  std::vector<PoseEstimate> estimates;
};

/// The log from a start that is 0.5 m and 10 degrees off.
LocalizedRun localize(const char* drawing, const Transform2<Map, Base>& start) {
  localization::Localizer localizer(drawn_walls(drawing), localization::InitialPose{start});
  sensors::carmen::CarmenReader log(kIntel / "intel.log");
  LocalizedRun run;
  (void)play_log(log, test::planar_lidar({0.0, 0.0, 0.3, 0.0}), localizer, [&](const PoseEstimate& e) {
    run.trajectory.push_back({e.stamp, e.map_from_base});
    run.estimates.push_back(e);
  });
  return run;
}

/// 0.5 m east and 10 degrees left of where the log begins.
const Transform2<Map, Base> kStart(24.92 + 0.5, 18.18, to_rad(-112.66 + 10.0));

TEST(IntelDrawing, FollowsTheLogOnALocallyWrongDrawing) {
  if (!std::filesystem::exists(kIntel / "intel.log")) GTEST_SKIP() << "no log at " << kIntel;
  const LocalizedRun run = localize("layout.png", kStart);
  std::vector<StampedPose> truth = load_tum(kIntel / "reference.tum");
  const Transform2<Map, Map> moved = load_map_from_reference(kIntel / "layout.yaml");
  for (StampedPose& pose : truth) pose.map_from_base = moved * pose.map_from_base;
  const nlohmann::json score = score_against_truth(run.trajectory, truth);
  EXPECT_EQ(score["matched"], 910);
  EXPECT_LT(score["position_m"]["median"].get<double>(), 0.29);  // a fifth of what the start was off stays
  EXPECT_LT(score["position_m"]["p95"].get<double>(), 0.5);
  EXPECT_LT(score["position_m"]["max"].get<double>(), 1.0);
  EXPECT_LT(score["heading_deg"]["mean"].get<double>(), 1.8);
  EXPECT_GT(score["within"]["share"].get<double>(), 0.9);
  const nlohmann::json pairs =
      score_against_relations(run.trajectory, load_relations(kIntel / "intel.relations"));
  EXPECT_LT(pairs["translation_m"]["mean"].get<double>(), 0.2);
  EXPECT_EQ(run.estimates.back().health.state, LocalizationState::Localized)
      << run.estimates.back().health.reason;
}

TEST(IntelDrawing, TheMirroredDrawingIsNotBelieved) {
  if (!std::filesystem::exists(kIntel / "intel.log")) GTEST_SKIP() << "no log at " << kIntel;
  const LocalizedRun run = localize("layout_mirrored.png", kStart);
  std::size_t believed = 0;
  for (const PoseEstimate& e : run.estimates)
    believed += e.health.state == LocalizationState::Localized ? 1 : 0;
  EXPECT_LT(20 * believed, run.estimates.size());
  EXPECT_EQ(run.estimates.back().health.state, LocalizationState::Lost);
}

}  // namespace
}  // namespace madori::app
