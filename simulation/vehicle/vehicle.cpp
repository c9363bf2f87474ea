#include "simulation/vehicle/vehicle.hpp"

#include <algorithm>
#include <cmath>

#include "simulation/random.hpp"
#include "simulation/world/world.hpp"

namespace madori::simulation {
namespace {

constexpr std::uint64_t kSlipStream = 0x511B;

VehicleSpec really(VehicleSpec spec, const mapping::VehicleRecord& record) {
  constexpr double kLinkAndStepS = 0.04;  // pass before the command is there
  if (!spec.as_recorded) return spec;
  spec.braking_mps2 = record.max_deceleration_mps2;
  spec.dead_time_s = std::max(0.0, record.reaction_s - kLinkAndStepS);
  spec.motor_lag_s = 0.0;
  return spec;
}

}  // namespace

Vehicle::Vehicle(const mapping::VehicleRecord& record, const VehicleSpec& spec, std::uint64_t seed)
    : record_(record), spec_(really(spec, record)), seed_(seed) {
  const double squat = 1.0 - spec.squat_percent_per_100kg / 100.0 * spec.load_kg / 100.0;
  wheels_.left_radius_m = record.wheel_radius_m * squat * (1.0 + spec.left_radius_error_percent / 100.0);
  wheels_.right_radius_m = record.wheel_radius_m * squat * (1.0 + spec.right_radius_error_percent / 100.0);
  wheels_.half_separation_m = record.half_wheel_separation_m * (1.0 + spec.separation_error_percent / 100.0);
}

double Vehicle::wheel_speed(double now_radps, double asked_radps, double radius_m, double dt_s) const {
  const double follow = spec_.motor_lag_s > 0.0 ? -std::expm1(-dt_s / spec_.motor_lag_s) : 1.0;
  const double change = (asked_radps - now_radps) * follow;
  const double mass_share = spec_.empty_mass_kg / (spec_.empty_mass_kg + spec_.load_kg);
  const double braking = spec_.braking_mps2 / radius_m * dt_s;
  // Brakes act on what turns; through standstill and on, the motor pushes.
  const bool brakes = change * now_radps < 0.0 && std::abs(now_radps) > braking;
  const double most = brakes ? braking : spec_.acceleration_mps2 * mass_share / radius_m * dt_s;
  return now_radps + std::clamp(change, -most, most);
}

VehicleState Vehicle::advance(const VehicleState& state, const control::WheelSpeeds& asked, double dt_s,
                              const ExtraSlip& slip, std::uint64_t tick) const {
  VehicleState next = state;
  next.left_radps = wheel_speed(state.left_radps, asked.left_radps, wheels_.left_radius_m, dt_s);
  next.right_radps = wheel_speed(state.right_radps, asked.right_radps, wheels_.right_radius_m, dt_s);
  const double left = (state.left_radps + next.left_radps) / 2.0 * dt_s;
  const double right = (state.right_radps + next.right_radps) / 2.0 * dt_s;
  next.left_rad += left;
  next.right_rad += right;
  const std::uint64_t bits = Random(seed_, kSlipStream, tick).next();
  const auto ground = [&](double turned, double extra, std::uint32_t chance, double radius_m) {
    const double grip = (1.0 - spec_.slip_percent / 100.0) * (1.0 - extra);
    const double noise_m =
        spec_.slip_noise * std::sqrt(std::abs(turned) * radius_m) * normal_from_bits(chance);
    return turned * grip + noise_m / radius_m;
  };
  const double left_ground = ground(left, slip.left, static_cast<std::uint32_t>(bits), wheels_.left_radius_m);
  const double right_ground =
      ground(right, slip.right, static_cast<std::uint32_t>(bits >> 32U), wheels_.right_radius_m);
  const Transform2<Base, Base> step = arc_step(wheels_, left_ground, right_ground);
  next.pose = state.pose * step;
  next.linear_mps =
      (left_ground * wheels_.left_radius_m + right_ground * wheels_.right_radius_m) / 2.0 / dt_s;
  next.angular_radps = step.yaw_rad() / dt_s;
  return next;
}

std::vector<Point2<Building>> Vehicle::footprint(const Transform2<Building, Base>& pose,
                                                 double margin_m) const {
  const Point2<Building> middle = pose * Point2<Base>{record_.length_m / 2.0 - record_.base_to_rear_m, 0.0};
  return rectangle(middle, pose.yaw_rad(), record_.length_m + 2.0 * margin_m,
                   record_.width_m + 2.0 * margin_m);
}

}  // namespace madori::simulation
