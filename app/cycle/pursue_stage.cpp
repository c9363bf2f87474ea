#include <algorithm>
#include <cmath>

#include "app/cycle/stages.hpp"
#include "core/angle.hpp"

namespace madori::app {
namespace {

/// Larger axis of the position's uncertainty.
double position_sigma(const PoseEstimate& pose) {
  const double xx = pose.covariance(0, 0);
  const double yy = pose.covariance(1, 1);
  const double xy = pose.covariance(0, 1);
  const double middle = (xx + yy) / 2.0;
  return std::sqrt(std::max(0.0, middle + std::hypot((xx - yy) / 2.0, xy)));
}

double speed_for_now(const CycleState& state, const CycleConfig& config) {
  const double care_m = std::max(0.0, state.ahead.care_along_m - state.progress.along_m);
  const bool narrow = state.block.squeeze.share < 1.0;
  const double care_mps = narrow ? config.narrow_speed_mps : config.care_speed_mps;
  const double care = std::sqrt(care_mps * care_mps + 2.0 * config.pursuit.speed.deceleration_mps2 * care_m);
  const bool degraded = state.pose.health.state == LocalizationState::Degraded;
  return degraded ? std::min(care, config.degraded_speed_mps) : care;
}

}  // namespace

Pursued pursue_way(const CycleState& state, const CycleConfig& config) {
  const double free_m = state.ahead.stop_along_m - state.progress.along_m;
  const auto out = control::pursue(state.way.path, state.progress.pursuit,
                                   {.map_from_base = state.pose.map_from_base,
                                    .position_sigma_m = position_sigma(state.pose),
                                    .free_distance_m = free_m,
                                    .turn_free = state.ahead.turn_free,
                                    .max_speed_mps = speed_for_now(state, config)},
                                   config.pursuit);
  return {out.command, {out.state, out.status, out.along_m, out.cross_track_m}};
}

}  // namespace madori::app
