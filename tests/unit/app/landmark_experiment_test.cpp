// The published corridor experiment, and what is written of a landmark map.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "app/landmarks/corridor_files.hpp"
#include "app/landmarks/corridor_run.hpp"
#include "app/landmarks/landmark_files.hpp"
#include "app/landmarks/on_drawing.hpp"
#include "localization/landmarks/surroundings.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/ray_caster.hpp"

namespace madori::app {
namespace {

CorridorScenario shipped() {
  return load_corridor_scenario(std::string(MADORI_SOURCE_DIR) + "/data/landmarks/corridor_square.yaml");
}

/// All 100 seeds: `madori landmarks --simulate data/landmarks/corridor_square.yaml --runs 100`.
TEST(LandmarkExperiment, AsPublished) {
  std::vector<CorridorRun> runs;
  for (unsigned seed = 1; seed <= 15; ++seed) runs.push_back(run_corridor(shipped(), seed));
  for (const CorridorRun& run : runs) {
    EXPECT_EQ(run.sightings.size(), 14U);
    EXPECT_EQ(
        std::count_if(run.sightings.begin(), run.sightings.end(), [](const auto& s) { return s.known; }), 10);
    EXPECT_EQ(run.sightings.back().landmarks.size(), 4U);
    // "The fourth landmark having the largest decrease" at the first closure.
    const auto& before = run.sightings[3].landmarks;
    const auto& after = run.sightings[4].landmarks;
    EXPECT_GT(before[3].sigma_m - after[3].sigma_m, before[1].sigma_m - after[1].sigma_m);
    EXPECT_GT(before[3].sigma_m - after[3].sigma_m, before[2].sigma_m - after[2].sigma_m);
  }
  const CorridorSummary all = summarise(runs);
  EXPECT_EQ(all.false_loops, 0);
  EXPECT_EQ(all.runs_within_two_sigma, all.runs);
  EXPECT_LE(all.worst_lap3_m, 0.01);
  EXPECT_LE(to_deg(all.worst_lap3_rad), 0.5);
  EXPECT_GT(all.mean_odometry_end_m, 0.05) << "odometry alone drifts";
}

TEST(LandmarkExperiment, LandmarksLieOnTheDrawingWhereTheStartWasGivenRoughly) {
  mapping::Walls walls;
  test::add_box(walls, 0.0, 0.0, 9.0, 6.0);
  test::add_box(walls, 2.0, 2.0, 5.0, 4.5);
  std::mt19937 random(5);
  const std::vector<Transform2<Map, Base>> places{{1.0, 1.0, 0.3}, {7.0, 1.2, 1.4}, {7.2, 5.2, 3.0}};
  localization::landmarks::LandmarkHub hub;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto scan = test::simulate_scan(walls, places[i], test::full_turn(360, 30.0), random);
    EXPECT_EQ(hub.add(localization::landmarks::look_around(localization::scan_points(scan, {})).descriptor),
              static_cast<int>(i));
    const auto way = places[0].inverse() * places[i];
    if (i > 0)
      hub.measure(0, static_cast<int>(i),
                  {{way.x_m(), way.y_m(), way.yaw_rad()},
                   {localization::landmarks::Matrix3::diagonal(1e-4, 1e-4, 1e-5)}});
  }
  const auto found = landmarks_on_drawing(hub, walls, {1.5, 0.6, 0.4});
  EXPECT_NEAR(found.x_m(), 1.0, 0.02);
  EXPECT_NEAR(found.y_m(), 1.0, 0.02);
  EXPECT_NEAR(found.yaw_rad(), 0.3, 0.005);
}

TEST(LandmarkExperiment, AnUnsureAgentReturnsToASureLandmark) {
  CorridorScenario scenario = shipped();
  EXPECT_EQ(run_corridor(scenario, 1).returns, 0);
  scenario.return_at_sigma_m = 0.01;
  const CorridorRun careful = run_corridor(scenario, 1);
  EXPECT_GT(careful.returns, 0);
  EXPECT_EQ(summarise({careful}).false_loops, 0);
}

TEST(LandmarkExperiment, FilesNameEveryLandmark) {
  const CorridorRun run = run_corridor(shipped(), 1);
  const std::string csv = corridor_csv(run);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 1 + 2 + 3 + 11 * 4);
  EXPECT_NE(corridor_figure(run).find("landmark 4"), std::string::npos);
  localization::landmarks::LandmarkHub hub;
  (void)hub.add({});
  (void)hub.add({});
  hub.measure(0, 1, {{1.0, 0.0, 0.0}, {localization::landmarks::Matrix3::diagonal(0.01, 0.04, 0.01)}});
  const auto placed = place_landmarks(hub, {5.0, 5.0, 0.5 * kPi});
  EXPECT_NEAR(placed[1].map_from_landmark.y_m(), 6.0, 1e-9);
  EXPECT_NEAR(placed[1].covariance(0, 0), 0.04, 1e-6) << "turned into the Map's axes";
  EXPECT_NE(landmarks_csv(placed).find("\n1,5.000000,6.000000,90.00000,0.200000,0.100000"),
            std::string::npos);
  EXPECT_NE(landmarks_dot(placed, hub).find("0 -- 1"), std::string::npos);
  EXPECT_NE(landmarks_geojson(placed, hub).find("\"edge\""), std::string::npos);
  EXPECT_GT(landmarks_picture(placed, hub, {}, {}).size(), 1000U);
}

}  // namespace
}  // namespace madori::app
