#pragma once

#include <optional>
#include <vector>

#include "core/stamp.hpp"

namespace madori::control {

/// How far the wheels had rolled at a moment, metres, by the encoders.
struct Rolled {
  Stamp stamp{};
  double way_m = 0.0;
};

/// A stop as it was: with these two numbers the vehicle needs v t + v^2 / 2a.
struct MeasuredStop {
  double speed_mps = 0.0;          ///< at which it was told to stop
  double deceleration_mps2 = 0.0;  ///< once it braked
  double latency_s = 0.0;          ///< from the word until it braked
  double way_m = 0.0;              ///< from the word until it stood
};

/// Whether the wheels stand at the end of what was recorded, for `still_s` at least.
[[nodiscard]] bool has_stopped(const std::vector<Rolled>& track, double still_s);

/// The stop in a track that begins at an even speed, at least 0.3 s before the word `told`, and ends
/// standing. The deceleration is the slope between 80 % and 20 % of the speed, where neither the motor's lag
/// at its begin nor the last creeping counts; the latency is what the way demands besides, so that a slow
/// begin and a creeping end are counted with it. Nothing where the vehicle did not drive, or has not come to
/// stand.
[[nodiscard]] std::optional<MeasuredStop> measure_stop(const std::vector<Rolled>& track, Stamp told);

}  // namespace madori::control
