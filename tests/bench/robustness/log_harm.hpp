#pragma once

#include <random>

#include "tests/bench/robustness/drawn_buildings.hpp"

namespace madori::bench {

/// What is done to a log before it is played.
struct LogHarm {
  double begin = 0.0;           ///< share of the log, by scans, that is left out at the beginning
  double end = 1.0;             ///< and where it stops
  int every = 1;                ///< scans kept: one in so many
  double distance_scale = 1.0;  ///< of the odometry
  double turn_scale = 1.0;
  double bias_rad_per_m = 0.0;  ///< added turn
  double noise = 0.0;           ///< sigma of each step, share of its way and turn, made worse by 3 in 1 of 50
  bool reversed = false;        ///< played backwards
};
[[nodiscard]] Records harmed(const Records& log, const LogHarm& harm, std::mt19937& engine);

}  // namespace madori::bench
