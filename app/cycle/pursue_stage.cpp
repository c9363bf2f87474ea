#include <algorithm>
#include <cmath>

#include "app/cycle/recoveries.hpp"
#include "app/cycle/stages.hpp"

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

}  // namespace

void foresee(CycleState& state, Stamp now, const CycleConfig& config) {
  const VelocityCommand measured{state.odometry.linear_mps(), state.odometry.angular_radps()};
  state.command_pose = state.pose.map_from_base * state.sent.way_until_obeyed(state.odometry.reading().stamp,
                                                                              measured, now, config.response);
}

planning::BrakingModel braking_once_obeyed(const CycleConfig& config) {
  planning::BrakingModel braking = config.check.braking;
  braking.reaction_s = 0.0;
  return braking;
}

bool stands(const CycleState& state) {
  constexpr double kStillMps = 0.01, kStillRadps = 0.01, kNowhereM = 0.002;
  const double coming_m =
      distance_m(state.command_pose.translation(), state.pose.map_from_base.translation());
  return std::abs(state.odometry.linear_mps()) < kStillMps &&
         std::abs(state.odometry.angular_radps()) < kStillRadps && coming_m < kNowhereM;
}

Pursued pursue_way(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  const double free_m = state.ahead.stop_along_m - state.progress.along_m;
  const auto out = control::pursue(state.way.path, state.progress.pursuit,
                                   {.map_from_base = state.command_pose,
                                    .position_sigma_m = position_sigma(state.pose),
                                    .free_distance_m = free_m,
                                    .turn_free = state.ahead.turn_free,
                                    .max_speed_mps = allowed_mps(state, input, config)},
                                   config.pursuit);
  return {out.command, {out.state, out.status, out.along_m, out.cross_track_m}};
}

}  // namespace madori::app
