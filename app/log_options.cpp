#include "app/log_options.hpp"

#include <cstdio>

#include "app/lidars.hpp"
#include "core/result.hpp"
#include "sensors/lidar/registry.hpp"

namespace madori::app {

LidarModel log_lidar(const mapping::Site& site) {
  for (const mapping::SensorRecord& sensor : site.sensors)
    if (!sensors::lidar_of(sensor.type, "site.yaml").has_field) return lidar_model(sensor);
  sensors::LidarSettings nobody;
  nobody.mounting = {0.0, 0.0, 0.0, 0.0};
  return sensors::lidar_rows().front().model(nobody);
}

sensors::LogOptions log_options(const mapping::Site& site, const std::filesystem::path& wheels) {
  sensors::LogOptions options;
  options.wheels = wheels;
  const mapping::VehicleRecord& vehicle = site.vehicle;
  options.geometry = {vehicle.wheel_radius_m, vehicle.wheel_radius_m, vehicle.half_wheel_separation_m};
  const LidarModel lidar = log_lidar(site);
  options.base_from_lidar = lidar.mounting.base_from_lidar();
  options.lidar_height_m = lidar.mounting.z_m;
  options.remark = [](const std::string& what) { std::fprintf(stderr, "madori: %s\n", what.c_str()); };
  return options;
}

void require_scans(std::size_t scans, const std::string& log) {
  if (scans == 0) throw Error(log, "holds no scan and no cloud", "give a log in which a lidar was recorded");
}

}  // namespace madori::app
