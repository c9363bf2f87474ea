#include <algorithm>
#include <array>
#include <cmath>

#include "app/cycle/stages.hpp"
#include "core/angle.hpp"
#include "core/fill_in.hpp"
#include "core/median.hpp"
#include "localization/mounting/wall_pieces.hpp"

namespace madori::app {
namespace {

using Of = MountingDoubt::Of;

// A hand's breadth: what is driven under, and what counts as a low body, is misjudged by as much.
constexpr double kHeightM = 0.1;
constexpr double kTiltRad = to_rad(3.0);
constexpr double kYawRad = to_rad(2.5);
constexpr double kYawStandsRad = to_rad(5.0);  // of what is seen 5 m ahead, 0.4 m lie beside where it stands
constexpr double kLegM = 0.8;

bool is_at_rest(const CycleState& state) {
  return state.drive_heard && state.limits.previous == VelocityCommand{} &&
         std::abs(state.odometry.linear_mps()) < 0.01 && std::abs(state.odometry.angular_radps()) < 0.01;
}

/// A look at the floor costs a millisecond: often until enough have agreed, then now and then. Whether it was
/// seen.
bool look_at_floor(MountingWatch& watch, const PointCloud<Lidar>& cloud, const CycleConfig& config,
                   Stamp now) {
  constexpr double kFirstS = 0.2, kLaterS = 10.0;
  if (cloud.lidar >= std::min(config.lidars.size(), MountingWatch::kLidars)) return false;
  const LidarModel& lidar = config.lidars[cloud.lidar];
  auto& floor = watch.floors[cloud.lidar];
  if (to_seconds(now - floor.looked) < (floor.count < MountingWatch::kLooks ? kFirstS : kLaterS))
    return false;
  floor.looked = now;
  const auto seen = localization::find_floor(cloud, lidar);
  if (!seen) return false;
  floor.height_m[floor.count % MountingWatch::kLooks] = seen->height_m;
  floor.tilt_rad[floor.count % MountingWatch::kLooks] = seen->tilt_rad();
  ++floor.count;
  return true;
}

std::optional<MountingDoubt> judge_floors(const MountingWatch& watch, const CycleConfig& config) {
  for (std::size_t i = 0; i < std::min(config.lidars.size(), MountingWatch::kLidars); ++i) {
    const auto& floor = watch.floors[i];
    if (floor.count < MountingWatch::kLooks) continue;
    const double typed_m = config.lidars[i].mounting.z_m;
    auto heights_m = floor.height_m, tilts_rad = floor.tilt_rad;
    const double height_m = median_of(heights_m), tilt_rad = median_of(tilts_rad);
    if (std::abs(height_m - typed_m) > kHeightM) return MountingDoubt{Of::Height, i, height_m, typed_m};
    if (tilt_rad > kTiltRad) return MountingDoubt{Of::Tilt, i, to_deg(tilt_rad), 0.0};
  }
  return std::nullopt;
}

/// Whoever drives straight on by the wheels, and gets beside where the lidar says it looks, has a lidar that
/// looks elsewhere. Whether a leg came to its end.
bool follow_leg(MountingWatch& watch, const CycleState& state) {
  constexpr double kStraightRad = to_rad(1.5), kSlowestMps = 0.1;
  const auto& odom_from_base = state.odometry.reading().odom_from_base;
  const bool straight = may_drive(state.pose.health.state) && state.odometry.linear_mps() > kSlowestMps;
  if (!straight) {
    watch.odom_begun.reset();
    return false;
  }
  if (!watch.odom_begun) {
    watch.odom_begun = odom_from_base;
    watch.map_begun = state.pose.map_from_base;
    return false;
  }
  const auto by_wheels = watch.odom_begun->inverse() * odom_from_base;
  const bool turned = std::abs(by_wheels.yaw_rad()) > kStraightRad;
  if (!turned && by_wheels.x_m() < kLegM) return false;
  const auto by_sight = watch.map_begun.inverse() * state.pose.map_from_base;
  watch.odom_begun.reset();
  const double off_m =
      std::hypot(by_sight.x_m(), by_sight.y_m()) - std::hypot(by_wheels.x_m(), by_wheels.y_m());
  if (turned || std::abs(wrap_angle(by_sight.yaw_rad() - by_wheels.yaw_rad())) > kStraightRad ||
      std::abs(off_m) > 0.1)
    return false;  // the place was corrected meanwhile
  watch.beside_rad[watch.legs % MountingWatch::kLegs] =
      wrap_angle(std::atan2(by_sight.y_m(), by_sight.x_m()) - std::atan2(by_wheels.y_m(), by_wheels.x_m()));
  ++watch.legs;
  return true;
}

/// By how much the newest legs led beside, where they agree on it.
template <std::size_t Legs>
std::optional<double> led_beside_rad(const MountingWatch& watch) {
  if (watch.legs < Legs) return std::nullopt;
  std::array<double, Legs> beside;
  for (std::size_t i = 0; i < Legs; ++i)
    beside[i] = watch.beside_rad[(watch.legs - 1 - i) % MountingWatch::kLegs];
  auto apart = beside;  // half a turn is its own neighbour on both sides
  for (double& one : apart) one = wrap_angle(one - beside.front());
  const double middle_rad = wrap_angle(beside.front() + median_of(apart));
  std::ranges::transform(beside, apart.begin(),
                         [&](double one) { return std::abs(wrap_angle(one - middle_rad)); });
  if (median_of(apart) > 0.4 * std::abs(middle_rad)) return std::nullopt;
  return middle_rad;
}

std::optional<MountingDoubt> judge_legs(const MountingWatch& watch, const CycleConfig& config) {
  constexpr std::size_t kFewLegs = 3;  // of 0.8 m: no correction of the place leads so far aside so often
  constexpr double kFarAsideRad = to_rad(20.0);
  std::optional<double> beside_rad = led_beside_rad<kFewLegs>(watch);
  if (!beside_rad || std::abs(*beside_rad) < kFarAsideRad)
    beside_rad = led_beside_rad<MountingWatch::kLegs>(watch);
  if (!beside_rad || std::abs(*beside_rad) < kYawRad) return std::nullopt;
  std::size_t lidar = 0;
  while (lidar + 1 < config.lidars.size() && !tells_place(config.lidars, lidar)) ++lidar;
  const double typed_deg = to_deg(config.lidars[lidar].mounting.yaw_rad);
  return MountingDoubt{Of::Yaw, lidar, to_deg(wrap_angle(to_rad(typed_deg) - *beside_rad)), typed_deg};
}

}  // namespace

void watch_mounting(CycleState& state, const CycleInput& input, const CycleConfig& config,
                    CycleOutput& output) {
  MountingWatch& watch = state.mounting;
  if (is_at_rest(state))
    for (const auto& cloud : input.clouds)
      if (look_at_floor(watch, cloud, config, input.now)) watch.height = judge_floors(watch, config);
  if (!follow_leg(watch, state)) return;
  const bool known = watch.yaw.has_value();
  watch.yaw = judge_legs(watch, config);
  if (watch.yaw && !known) output.events.push_back(mounting_notice(*watch.yaw, config).text);
}

bool mounting_forbids(const MountingWatch& watch) {
  if (watch.height) return true;
  return watch.yaw && std::abs(wrap_angle(to_rad(watch.yaw->found - watch.yaw->typed))) > kYawStandsRad;
}

Notice mounting_notice(const MountingDoubt& doubt, const CycleConfig& config) {
  const auto say = [&](Cause cause) {
    return notice(cause, {{"name", config.lidars[doubt.lidar].name},
                          {"found", two_decimals(doubt.found)},
                          {"typed", two_decimals(doubt.typed)}});
  };
  switch (doubt.of) {
    case Of::Height:
      return say(Cause::LidarHeight);
    case Of::Tilt:
      return say(Cause::LidarLeans);
    case Of::Yaw:
      break;
  }
  return say(Cause::LidarYaw);
}

}  // namespace madori::app
