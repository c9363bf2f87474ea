#include "control/limits/limits.hpp"

#include <algorithm>
#include <cmath>

namespace madori::control {
namespace {

/// How much of `wanted` stays when its magnitude may be at most `most`.
double share_within(double wanted, double most) {
  return std::abs(wanted) <= most ? 1.0 : most / std::abs(wanted);
}

/// The magnitude that was driven in the direction of `requested` before.
double already(double previous, double requested) {
  return previous * requested > 0.0 ? std::abs(previous) : 0.0;
}

}  // namespace

LimitOutput limit(const LimitState& state, const LimitInput& input, const LimitOptions& options) {
  const auto& [linear, angular] = input.requested;
  const bool finite = std::isfinite(linear) && std::isfinite(angular) && std::isfinite(input.step_s);
  if (!input.may_move || !finite || !(input.step_s > 0.0) || std::isnan(input.speed_cap_mps)) return {};

  const double wheel = std::abs(linear) + std::abs(angular) * options.half_wheel_separation_m;
  const double cap = std::min(options.max_speed_mps, std::max(input.speed_cap_mps, 0.0));
  const double before = already(state.previous.linear_mps, linear);
  const double growth =
      std::min(options.acceleration_mps2, state.acceleration_mps2 + options.jerk_mps3 * input.step_s);
  // One share for both parts keeps the curve that was asked for.
  const double share = std::min({share_within(linear, std::min(cap, before + growth * input.step_s)),
                                 share_within(angular, options.max_turn_rate_radps),
                                 share_within(wheel, options.max_wheel_speed_mps)});
  // A turn that grows too fast is lowered alone: slowing the vehicle for it would stop it at every curve.
  const double turn =
      already(state.previous.angular_radps, angular) + options.turn_acceleration_radps2 * input.step_s;
  const VelocityCommand command{linear * share, angular * std::min(share, share_within(angular, turn))};
  const double gained = std::max(0.0, (std::abs(command.linear_mps) - before) / input.step_s);
  return {{command, gained}, command};
}

}  // namespace madori::control
