#include "app/cycle/site_config.hpp"

#include <algorithm>
#include <utility>

#include "app/lidars.hpp"
#include "mapping/site/file_identity.hpp"
#include "mapping/site/site_transaction.hpp"
#include "planning/route_graph/route_csv.hpp"

namespace madori::app {
namespace {

/// The slowest lidar rules how late something is seen; the highest one must fit under what is driven under.
void take_lidars(std::vector<LidarModel> lidars, CycleConfig& config) {
  constexpr double kHeadroomM = 0.1;
  double top_m = config.check.vehicle.height_m;
  for (const LidarModel& lidar : lidars) {
    top_m = std::max(top_m, lidar.mounting.z_m);
    config.check.braking.scan_period_s = std::max(config.check.braking.scan_period_s, lidar.period_s);
  }
  config.field.top_m = top_m + kHeadroomM;
  config.sure_range_m = std::min(sure_ahead_m(lidars, config.check.vehicle.front_m), config.looked_at_m());
  config.sure_low_m = sure_low_m(lidars, config.check.vehicle.front_m, config.field.reach_m);
  config.lidars = std::move(lidars);
}

void take_vehicle(const mapping::VehicleRecord& v, CycleConfig& config) {
  constexpr double kComfort = 0.5;  ///< share of the brakes that an ordinary stop uses
  constexpr double kTurnComfort = 2.0 / 3.0;
  constexpr double kUnforeseenS = 0.1;  ///< the wheels may obey so much earlier or later than the record says
  config.odometry.wheels = {v.wheel_radius_m, v.wheel_radius_m, v.half_wheel_separation_m};
  config.check.vehicle = planning::outline_of(v);
  config.pursuit.speed.max_speed_mps = v.max_speed_mps;
  config.pursuit.speed.max_turn_rate_radps = v.max_turn_rate_radps;
  config.pursuit.speed.deceleration_mps2 = kComfort * v.max_deceleration_mps2;
  config.pursuit.speed.reaction_s = kUnforeseenS;
  config.response = {v.reaction_s, v.max_deceleration_mps2, v.max_turn_acceleration_radps2};
  config.pursuit.turn_acceleration_radps2 = kTurnComfort * v.max_turn_acceleration_radps2;
  config.limits.max_speed_mps = v.max_speed_mps;
  config.limits.max_turn_rate_radps = v.max_turn_rate_radps;
  config.limits.max_wheel_speed_mps =
      v.max_speed_mps + 0.5 * v.max_turn_rate_radps * v.half_wheel_separation_m;
  constexpr double kDamaged = 1.5;  ///< so much faster than it may, no wheel turns
  config.odometry.max_wheel_speed_radps = kDamaged * config.limits.max_wheel_speed_mps / v.wheel_radius_m;
  config.limits.half_wheel_separation_m = v.half_wheel_separation_m;
  config.limits.acceleration_mps2 = v.max_acceleration_mps2;
  config.limits.turn_acceleration_radps2 = v.max_turn_acceleration_radps2;
  config.check.braking.deceleration_mps2 = v.max_deceleration_mps2;
  config.check.braking.turn_deceleration_radps2 = v.max_turn_acceleration_radps2;
  config.check.braking.reaction_s = v.reaction_s;
  config.wheel_watch.half_separation_m = v.half_wheel_separation_m;
  config.wheel_watch.acceleration_mps2 = std::min(v.max_acceleration_mps2, v.max_deceleration_mps2);
  config.wheel_watch.lag_s = v.reaction_s;
  config.movers.gain_mps2 = v.max_acceleration_mps2;
  config.movers.top_speed_mps = v.max_speed_mps;
}

/// What else guards people: fields of safety scanners, which must stay free, and what the integrator names.
void take_protection(const mapping::Site& site, CycleConfig& config) {
  auto& field = config.check.protective;
  for (const auto& sensor : site.sensors)
    field = {std::max(field.ahead_m, sensor.protective_m),
             std::max(field.beside_m, sensor.protective_side_m)};
  config.low_bodies_guarded_by = site.low_bodies_guarded_by;
}

SiteForDriving load_as_it_is(const std::filesystem::path& folder) {
  SiteForDriving loaded{mapping::load_scaled_site(folder), mapping::load_walls(folder / "walls.csv"), {}};
  auto routes = planning::load_routes(folder / "routes");
  loaded.config = vehicle_config(loaded.site.vehicle, lidars_of(loaded.site, folder));
  CycleConfig& config = loaded.config;
  take_protection(loaded.site, config);
  config.metric = loaded.site.shortest_routes ? planning::RouteMetric::Metres : planning::RouteMetric::Hops;
  std::vector<Segment2<Map>> segments;
  for (const auto& wall : loaded.walls) segments.push_back(wall.segment);
  config.walls = std::make_shared<const planning::WallGrid>(std::move(segments));
  take_routes(std::move(routes), config);
  return loaded;
}

}  // namespace

CycleConfig vehicle_config(const mapping::VehicleRecord& vehicle, std::vector<LidarModel> lidars) {
  CycleConfig config;
  take_vehicle(vehicle, config);
  take_lidars(std::move(lidars), config);
  return config;
}

CycleConfig config_for_mapping(const mapping::Site& setup, const std::filesystem::path& where) {
  CycleConfig config = vehicle_config(setup.vehicle, lidars_of(setup, where));
  take_protection(setup, config);
  config.mapping = true;
  for (SafetyRule& rule : config.safety_rules) rule.by_hand = rule.holds != field_is_entered;
  return config;
}

SiteForDriving load_for_driving(const std::filesystem::path& folder) {
  mapping::SiteIdentity before;
  const auto read = [&] {
    before = mapping::site_identity(folder);
    return load_as_it_is(folder);
  };
  return mapping::read_unchanged(folder, read, [&](const SiteForDriving& /*loaded*/) {
    return mapping::site_identity(folder) == before;
  });
}

void take_routes(planning::RouteGraph routes, CycleConfig& config) {
  config.routes = std::move(routes);
  config.tight_corners =
      planning::tight_corners(config.routes, *config.walls, config.check.vehicle, config.waypoints);
  // Where it would turn about a manoeuvre may do.
  std::erase_if(config.tight_corners, [](const auto& corner) { return corner.from == corner.to; });
}

}  // namespace madori::app
