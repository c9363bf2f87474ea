#include "app/log_options.hpp"

#include "core/angle.hpp"

namespace madori::app {

sensors::LogOptions log_options(const mapping::Site& site, const std::filesystem::path& wheels) {
  sensors::LogOptions options;
  options.wheels = wheels;
  const mapping::VehicleRecord& vehicle = site.vehicle;
  options.geometry = {vehicle.wheel_radius_m, vehicle.wheel_radius_m, vehicle.half_wheel_separation_m};
  for (const mapping::SensorRecord& sensor : site.sensors) {
    if (sensor.type == "s300") continue;  // the safety scanner
    options.base_from_lidar = {sensor.x_m, sensor.y_m, to_rad(sensor.yaw_deg)};
    options.lidar_height_m = sensor.z_m;
    break;
  }
  return options;
}

}  // namespace madori::app
