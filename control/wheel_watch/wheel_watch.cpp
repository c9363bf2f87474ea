#include "control/wheel_watch/wheel_watch.hpp"

#include <algorithm>
#include <cmath>

#include "control/diff_drive/kinematics.hpp"

namespace madori::control {

void WheelWatch::Wheel::ask(double mps, double share, double step_mps) {
  const double slack_mps = share * std::abs(mps);  // who turns by it faster also needs by it longer to stop
  least_mps = std::min(mps - slack_mps, least_mps + step_mps);
  most_mps = std::max(mps + slack_mps, most_mps - step_mps);
}

double WheelWatch::Wheel::beyond_mps(double turned_mps, double share) const {
  const double still_mps = share * std::max(std::abs(least_mps), std::abs(most_mps));
  const double above = turned_mps - most_mps, below = turned_mps - least_mps;
  if (above > 0.0) return most_mps < 0.0 && turned_mps < still_mps ? -above : above;
  if (below < 0.0) return least_mps > 0.0 && turned_mps > -still_mps ? below : -below;
  return 0.0;
}

std::optional<DisobedientWheel> WheelWatch::update(const std::optional<VelocityCommand>& asked,
                                                   const VelocityCommand& turned, double step_s,
                                                   const WheelWatchOptions& options) {
  const auto of_wheels = [&](const VelocityCommand& v) {
    const RimSpeeds rims = rim_speeds(options.half_separation_m, v);
    return std::array{rims.left_mps, rims.right_mps};
  };
  const auto turned_mps = of_wheels(turned), asked_mps = of_wheels(asked.value_or(turned));
  std::array<double, 2> beyond_mps{};
  for (std::size_t k = 0; k < 2; ++k) {
    if (!asked) wheels_[k] = {turned_mps[k], turned_mps[k]};
    if (asked) wheels_[k].ask(asked_mps[k], options.share, options.acceleration_mps2 * step_s);
    beyond_mps[k] = wheels_[k].beyond_mps(turned_mps[k], options.share);
  }
  // A wheel that turns by that share more than it is asked also changes its speed by so much more.
  const double late_mps = (1.0 + options.share) * options.acceleration_mps2 * options.lag_s;
  const bool held = beyond_mps[0] < 0.0 && beyond_mps[1] < 0.0;
  std::optional<DisobedientWheel> found;
  for (std::size_t k = 0; k < 2; ++k) {
    const bool outside = !held && std::abs(beyond_mps[k]) > late_mps;
    wheels_[k].outside_s = outside ? wheels_[k].outside_s + step_s : 0.0;
    if (wheels_[k].outside_s < options.patience_s) continue;
    if (asked && !found) found = DisobedientWheel{k == 0, asked_mps[k], turned_mps[k]};
    wheels_[k] = {turned_mps[k], turned_mps[k]};
  }
  return found;
}

}  // namespace madori::control
