#pragma once

#include <functional>
#include <string>
#include <vector>

#include "localization/mounting/mounting_calibration.hpp"
#include "mapping/site/site.hpp"

namespace madori::test {

/// A short drive in a virtual hall with machines, pillars and a person who walks through, with the noise of
/// the sensors, wheels that slip and are not as large as believed, and lidars that hang elsewhere than typed.
struct MountingTrial {
  std::vector<mapping::SensorRecord> truth;  ///< how they really hang
  std::vector<mapping::SensorRecord> typed;
  std::uint64_t seed = 1;
  bool corridor = false;  ///< 60 m by 3.2 m with nothing along its walls, instead of the hall
  double way_m = 1.0;
  double turn_rad = 6.283185307179586;
  double pressed_at_s = -1.0;  ///< the emergency stop, for 0.3 s; below 0: never
  std::function<void(localization::MountingDrive&)>
      wired_wrongly;  ///< what became of it before it was looked at
};

struct MountingTrialResult {
  bool driven = false;       ///< the manoeuvre came to its end
  std::string stopped;       ///< why it did not
  std::size_t contacts = 0;  ///< of the vehicle with anything
  localization::MountingCalibration found;
  double wall_s = 0.0;  ///< that the calibration computed
};

[[nodiscard]] MountingTrialResult run_mounting_trial(const MountingTrial& trial);

/// A lidar of that kind at a random place on the vehicle, and as a person may have typed it: up to 0.2 m and
/// 20 degrees beside.
[[nodiscard]] MountingTrial random_mounting(const std::string& type, std::uint64_t seed);

}  // namespace madori::test
