#include "app/cycle/site_config.hpp"

#include <algorithm>

#include "core/angle.hpp"
#include "core/result.hpp"
#include "planning/route_graph/route_csv.hpp"

namespace madori::app {
namespace {

constexpr double kVlp16ElevationRad = to_rad(15.0);

const mapping::SensorRecord& vlp16_of(const mapping::Site& site, const std::filesystem::path& folder) {
  const auto found = std::find_if(site.sensors.begin(), site.sensors.end(),
                                  [](const auto& sensor) { return sensor.type == "vlp16"; });
  if (found == site.sensors.end())
    throw Error((folder / "site.yaml").string(), "names no VLP-16, which the vehicle needs to drive",
                "add it below sensors: with its place on the vehicle");
  return *found;
}

void take_vehicle(const mapping::VehicleRecord& v, CycleConfig& config) {
  config.odometry.wheels = {v.wheel_radius_m, v.wheel_radius_m, v.half_wheel_separation_m};
  config.check.vehicle = {v.length_m - v.base_to_rear_m, v.base_to_rear_m, v.width_m / 2.0, v.height_m};
  config.field.top_m = v.height_m + 0.1;
  config.pursuit.speed.max_speed_mps = v.max_speed_mps;
  config.pursuit.speed.max_turn_rate_radps = v.max_turn_rate_radps;
  config.limits.max_speed_mps = v.max_speed_mps;
  config.limits.max_turn_rate_radps = v.max_turn_rate_radps;
  config.limits.max_wheel_speed_mps =
      v.max_speed_mps + 0.5 * v.max_turn_rate_radps * v.half_wheel_separation_m;
  config.limits.half_wheel_separation_m = v.half_wheel_separation_m;
  config.limits.acceleration_mps2 = v.max_acceleration_mps2;
  config.movers.gain_mps2 = v.max_acceleration_mps2;
  config.movers.top_speed_mps = v.max_speed_mps;
}

}  // namespace

SiteForDriving load_for_driving(const std::filesystem::path& folder) {
  SiteForDriving loaded{mapping::load_scaled_site(folder), mapping::load_walls(folder / "walls.csv"), {}};
  CycleConfig& config = loaded.config;
  config.routes = planning::load_routes(folder / "routes");
  take_vehicle(loaded.site.vehicle, config);
  const auto& lidar = vlp16_of(loaded.site, folder);
  config.lidar = {lidar.x_m, lidar.y_m, lidar.z_m, -kVlp16ElevationRad, kVlp16ElevationRad};
  config.lidar_yaw_rad = to_rad(lidar.yaw_deg);
  for (const auto& sensor : loaded.site.sensors)
    config.check.protective_m = std::max(config.check.protective_m, sensor.protective_m);
  std::vector<Segment2<Map>> segments;
  for (const auto& wall : loaded.walls) segments.push_back(wall.segment);
  config.walls = std::make_shared<const planning::WallGrid>(std::move(segments));
  return loaded;
}

}  // namespace madori::app
