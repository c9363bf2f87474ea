#include "control/prediction/coming_pose.hpp"

#include <algorithm>
#include <cmath>

namespace madori::control {
namespace {

/// The arc of constant speeds (exact, as the odometry's).
Transform2<Base, Base> arc(const VelocityCommand& v, double time_s) {
  const double half_turn = 0.5 * v.angular_radps * time_s;
  const double way_m = v.linear_mps * time_s;
  const double chord_m = std::abs(half_turn) < 1e-9 ? way_m : way_m * std::sin(half_turn) / half_turn;
  return {chord_m * std::cos(half_turn), chord_m * std::sin(half_turn), 2.0 * half_turn};
}

constexpr double kOldestPoseS = 0.5;  ///< an older pose is of a drive that is silent, or was never heard

double towards(double now, double wanted, double most) {
  return now + std::clamp(wanted - now, -most, most);
}

}  // namespace

void SentCommands::add(Stamp at, const VelocityCommand& command, const WheelResponse& response) {
  sent_.push_back({at, command});
  const Stamp obeyed = at - duration_from_seconds(response.reaction_s + kOldestPoseS);
  while (sent_.size() > 1 && (*(sent_.begin() + 1)).at <= obeyed) sent_.pop_front();
}

Transform2<Base, Base> SentCommands::way_until_obeyed(Stamp measured, const VelocityCommand& velocity,
                                                      Stamp now, const WheelResponse& response) const {
  constexpr double kStepS = 0.02;
  const Duration reaction = duration_from_seconds(response.reaction_s);
  const Duration step = duration_from_seconds(kStepS);
  Transform2<Base, Base> way;
  VelocityCommand v = velocity;
  auto obeyed = sent_.begin();
  for (Stamp t = std::max(measured, now - duration_from_seconds(kOldestPoseS));
       t < now + reaction && !sent_.empty();) {
    const Stamp end = std::min(t + step, now + reaction);
    const double dt_s = to_seconds(end - t);
    while (obeyed + 1 != sent_.end() && (obeyed + 1)->at + reaction <= t) ++obeyed;
    // Before the first that is known the vehicle keeps what was measured.
    const VelocityCommand wanted = obeyed->at + reaction <= t ? obeyed->command : v;
    v = {towards(v.linear_mps, wanted.linear_mps, response.change_mps2 * dt_s),
         towards(v.angular_radps, wanted.angular_radps, response.turn_change_radps2 * dt_s)};
    way = way * arc(v, dt_s);
    t = end;
  }
  return way;
}

}  // namespace madori::control
