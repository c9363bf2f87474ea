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
  const double care_m = std::max(0.0, state.way.care_along_m - state.way.along_m);
  const bool narrow = state.way.squeeze.share < 1.0;
  const double care_mps = narrow ? config.narrow_speed_mps : config.care_speed_mps;
  const double care = std::sqrt(care_mps * care_mps + 2.0 * config.pursuit.speed.deceleration_mps2 * care_m);
  const bool degraded = state.pose.health.state == LocalizationState::Degraded;
  return degraded ? std::min(care, config.degraded_speed_mps) : care;
}

}  // namespace

control::PursuitOutput follow(const CycleState& state, const CycleConfig& config) {
  const Navigation& way = state.way;
  return control::pursue(way.path, way.pursuit,
                         {.map_from_base = state.pose.map_from_base,
                          .position_sigma_m = position_sigma(state.pose),
                          .free_distance_m = way.stop_along_m - way.along_m,
                          .turn_free = way.turn_free,
                          .max_speed_mps = speed_for_now(state, config)},
                         config.pursuit);
}

VelocityCommand wanted_command(CycleState& state, const CycleInput& input, const CycleConfig& config) {
  if (state.mode == Mode::Manual)
    return to_seconds(input.now - state.jog_heard) <= config.jog_timeout_s ? state.jog : VelocityCommand{};
  if (!drives(state.mode)) return {};
  Navigation& way = state.way;
  const auto out = follow(state, config);
  way.pursuit = out.state;
  way.status = out.status;
  way.along_m = out.along_m;
  way.cross_track_m = out.cross_track_m;
  if (out.status == control::PursuitStatus::Arrived && way.backing) {
    end_back_out(state);
  } else if (out.status == control::PursuitStatus::Arrived) {
    way.arrived = true;
    way.dwell_until = input.now + duration_from_seconds(way.stop.wait_s);
  }
  return out.command;
}

}  // namespace madori::app
