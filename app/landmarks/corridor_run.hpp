#pragma once

#include <vector>

#include "app/landmarks/corridor_scenario.hpp"
#include "core/frames.hpp"
#include "core/point2.hpp"

namespace madori::app {

/// A landmark after one sighting, against the truth.
struct LandmarkState {
  double error_m = 0.0;
  double error_rad = 0.0;
  double sigma_m = 0.0;  ///< the published U_D
  double sigma_rad = 0.0;
  double published_sigma_m = 0.0;  ///< of the scalar form on the same measurements
  double published_error_m = 0.0;
  bool within_two_sigma = true;  ///< x, y and heading, each
};

/// One scan at a corner.
struct CornerSighting {
  int lap = 0;  ///< 1 is the first
  int landmark = 0;
  bool known = false;
  bool false_loop = false;  ///< recognised as a landmark of another corner
  double agent_error_m = 0.0;
  double agent_error_rad = 0.0;
  double odometry_error_m = 0.0;
  double odometry_error_rad = 0.0;
  std::vector<LandmarkState> landmarks;  ///< all so far
};

struct CorridorRun {
  std::vector<CornerSighting> sightings;
  std::vector<Point2<Map>> truth, by_odometry, by_landmarks;  ///< the ways driven, for the picture
  int returns = 0;  ///< to a surer landmark, where the scenario asks for it
};

/// The published experiment (Peter and Kiss 2020, section III) with made-up errors: laps around a corridor
/// square, a 90 degree right turn at the first corner before the start, the first side once more at the end.
/// Frame: landmark 0, that is the start.
[[nodiscard]] CorridorRun run_corridor(const CorridorScenario& scenario, unsigned seed);

/// What the runs of many seeds say, in the terms of the acceptance.
struct CorridorSummary {
  int runs = 0;
  int sightings = 0, matches = 0, false_loops = 0;
  int runs_within_two_sigma = 0;  ///< every landmark, from the first closed loop on to the end of lap 2
  double worst_lap3_m = 0.0;      ///< agent at a corner
  double worst_lap3_rad = 0.0;
  double worst_landmark_m = 0.0;  ///< at the end
  double mean_odometry_end_m = 0.0;
  double mean_odometry_end_rad = 0.0;
};
[[nodiscard]] CorridorSummary summarise(const std::vector<CorridorRun>& runs);

}  // namespace madori::app
