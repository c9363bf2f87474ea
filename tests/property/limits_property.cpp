// The limiter's law: it never raises a speed, never turns a sign, and never changes a legal command.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "control/limits/limits.hpp"

namespace madori::control {
namespace {

double between(double low, double high) {
  return low + (high - low) * *rc::gen::inRange(0, 100'001) / 100'000.0;
}

struct Case {
  LimitOptions options;
  LimitState state;
  LimitInput input;
};

Case any_case() {
  Case c;
  c.options = {between(0.1, 2.0), between(0.1, 2.0), between(0.1, 3.0), between(0.1, 0.5),
               between(0.1, 2.0), between(0.1, 3.0), between(0.1, 5.0)};
  c.state.previous = {between(-2.0, 2.0), between(-2.0, 2.0)};
  c.state.acceleration_mps2 = between(0.0, c.options.acceleration_mps2);
  c.input.requested = {between(-3.0, 3.0), between(-3.0, 3.0)};
  c.input.speed_cap_mps = *rc::gen::arbitrary<bool>() ? between(0.0, 2.0) : 10.0;
  c.input.step_s = between(0.001, 0.2);
  return c;
}

/// Written down on its own, from the header's words.
bool is_legal(const Case& c, const VelocityCommand& command) {
  const double v = std::abs(command.linear_mps);
  const double w = std::abs(command.angular_radps);
  const auto& [options, state, input] = c;
  const bool same_v = command.linear_mps * state.previous.linear_mps > 0.0;
  const bool same_w = command.angular_radps * state.previous.angular_radps > 0.0;
  const double v_before = same_v ? std::abs(state.previous.linear_mps) : 0.0;
  const double w_before = same_w ? std::abs(state.previous.angular_radps) : 0.0;
  const double growth =
      std::min(options.acceleration_mps2, state.acceleration_mps2 + options.jerk_mps3 * input.step_s);
  return input.may_move && v <= options.max_speed_mps && v <= input.speed_cap_mps &&
         w <= options.max_turn_rate_radps &&
         v + w * options.half_wheel_separation_m <= options.max_wheel_speed_mps &&
         v <= v_before + growth * input.step_s &&
         w <= w_before + options.turn_acceleration_radps2 * input.step_s;
}

RC_GTEST_PROP(LimitsProperty, NeverRaisesASpeedAndNeverTurnsASign, ()) {
  const Case c = any_case();
  const auto out = limit(c.state, c.input, c.options).command;
  RC_ASSERT(std::abs(out.linear_mps) <= std::abs(c.input.requested.linear_mps));
  RC_ASSERT(std::abs(out.angular_radps) <= std::abs(c.input.requested.angular_radps));
  RC_ASSERT(out.linear_mps * c.input.requested.linear_mps >= 0.0);
  RC_ASSERT(out.angular_radps * c.input.requested.angular_radps >= 0.0);
}

RC_GTEST_PROP(LimitsProperty, WhatComesOutIsLegal, ()) {
  Case c = any_case();
  auto out = limit(c.state, c.input, c.options).command;
  out.linear_mps *= 1.0 - 1e-12;  // one rounding of room
  out.angular_radps *= 1.0 - 1e-12;
  RC_ASSERT(is_legal(c, out));
}

RC_GTEST_PROP(LimitsProperty, NeverChangesALegalCommand, ()) {
  Case c = any_case();
  c.input.requested = limit(c.state, c.input, c.options).command;
  c.input.requested.linear_mps *= 1.0 - 1e-12;
  c.input.requested.angular_radps *= between(0.0, 1.0);
  RC_ASSERT(is_legal(c, c.input.requested));
  RC_ASSERT(limit(c.state, c.input, c.options).command == c.input.requested);
}

/// Of commands alone: the speed that one step gains is at most what the step before gained, and the jerk.
RC_GTEST_PROP(LimitsProperty, TheGainOfSpeedGrowsNoFasterThanTheJerk, ()) {
  Case c = any_case();
  c.state = {};
  double gain_mps2 = 0.0, previous_mps = 0.0;
  for (int step = 0; step < 30; ++step) {
    if (*rc::gen::inRange(0, 5) == 0) c.input.requested = any_case().input.requested;
    const auto out = limit(c.state, c.input, c.options);
    c.state = out.state;
    const double now_mps = out.command.linear_mps;
    const double before_mps = now_mps * previous_mps > 0.0 ? std::abs(previous_mps) : 0.0;
    const double gained_mps2 = std::max(0.0, std::abs(now_mps) - before_mps) / c.input.step_s;
    RC_ASSERT(gained_mps2 <= gain_mps2 + c.options.jerk_mps3 * c.input.step_s + 1e-9);
    gain_mps2 = gained_mps2;
    previous_mps = now_mps;
  }
}

RC_GTEST_PROP(LimitsProperty, BackwardsAsForwards, ()) {
  const Case c = any_case();
  const auto mirrored = [](const VelocityCommand& v) {
    return VelocityCommand{-v.linear_mps, -v.angular_radps};
  };
  Case back = c;
  back.state.previous = mirrored(c.state.previous);
  back.input.requested = mirrored(c.input.requested);
  const auto forth = limit(c.state, c.input, c.options), turned = limit(back.state, back.input, c.options);
  RC_ASSERT(turned.command == mirrored(forth.command));
  RC_ASSERT(turned.state.acceleration_mps2 == forth.state.acceleration_mps2);
}

RC_GTEST_PROP(LimitsProperty, StopsWhenItMayNotMove, ()) {
  Case c = any_case();
  c.input.may_move = false;
  RC_ASSERT(limit(c.state, c.input, c.options).command == VelocityCommand{});
}

}  // namespace
}  // namespace madori::control
