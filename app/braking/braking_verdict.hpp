#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/cycle/cycle.hpp"
#include "control/braking/measured_stop.hpp"
#include "mapping/site/site.hpp"

namespace madori::app {

/// A measured stop, and whether the vehicle carried its load.
struct BrakingStop {
  bool loaded = false;
  control::MeasuredStop stop;
};

/// What the stops say that the site's record should hold: the worst of them, rounded to the safe side. The
/// record is of the loaded vehicle: where none of them was, nothing better than what it holds.
struct BrakingVerdict {
  double deceleration_mps2 = 0.0;
  double reaction_s = 0.0;   ///< latency, and the cycle's period that what is seen waits for its step
  double needs_m = 0.0;      ///< to stand from the site's top speed, from when something could be seen
  double sees_m = 0.0;       ///< how far ahead something is sure to be seen
  double allowed_mps = 0.0;  ///< the greatest top speed at which `needs_m` is within `sees_m`
};

/// What a site says of the way to stand.
struct BrakingSite {
  double top_speed_mps = 0.0;
  double sees_m = 0.0;  ///< how far ahead something is sure to be seen (sure_ahead_m)
  double scan_period_s = 0.0;
  double way_m = 0.0;  ///< that a test from the top speed needs (braking_test_way_m)
  double deceleration_mps2 = 0.0, reaction_s = 0.0;  ///< of the record
};
[[nodiscard]] BrakingSite braking_site(const CycleConfig& config);

/// Nothing without a stop.
[[nodiscard]] std::optional<BrakingVerdict> verdict_of(const std::vector<BrakingStop>& stops,
                                                       const BrakingSite& site);

/// Whether a top speed outruns the lidar with the measured values.
[[nodiscard]] inline bool outruns(const BrakingVerdict& verdict, double top_speed_mps) {
  return top_speed_mps > verdict.allowed_mps;
}

/// The record with the verdict's values. Throws Error, which names the speed, where its top speed would
/// outrun the lidar and may not be lowered (`lower_speed`).
[[nodiscard]] mapping::VehicleRecord with_measured(mapping::VehicleRecord record,
                                                   const BrakingVerdict& verdict, bool lower_speed);

}  // namespace madori::app
