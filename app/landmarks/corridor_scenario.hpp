#pragma once

#include <filesystem>

namespace madori::app {

/// Random errors that grow with the root of the way; a turn counts in full turns.
struct WheelNoise {
  double distance_m_per_root_m = 0.0;
  double heading_rad_per_root_m = 0.0;
  double turn_rad_per_root_turn = 0.0;
};

/// The corridor square of the published experiment and how the agent drives and errs in it.
struct CorridorScenario {
  double outside_m = 2.0;
  double width_m = 0.5;
  int laps = 3;
  int beams = 360;
  double range_sigma_m = 0.0;
  double least_incidence_rad = 0.0;
  double corner_sigma_m = 0.0;
  double distance_error = 0.0;  ///< share that the wheels report too much
  double turn_error = 0.0;      ///< share
  double heading_error_rad_per_m = 0.0;
  WheelNoise random;
  WheelNoise believed;
  double return_at_sigma_m =
      0.0;  ///< own position sigma beyond which the agent returns to a sure landmark; 0: never
};

/// Throws Error with file and line on anything missing, unknown or out of range.
[[nodiscard]] CorridorScenario load_corridor_scenario(const std::filesystem::path& file);

}  // namespace madori::app
