#include "app/log_options.hpp"

#include <cstdio>

#include "app/lidars.hpp"
#include "app/recording/recorder.hpp"
#include "core/result.hpp"
#include "sensors/lidar/registry.hpp"

namespace madori::app {
namespace {

std::vector<sensors::MountedLidar> mounted(const LogLidars& lidars) {
  std::vector<sensors::MountedLidar> all;
  for (std::size_t place = 0; place < lidars.all.size(); ++place) {
    const LidarModel& lidar = lidars.all[place];
    all.push_back({lidar.name, lidar_frame(lidar), place, lidar.kind == LidarKind::Planar,
                   lidar.mounting.base_from_lidar(), lidar.mounting.z_m});
  }
  return all;
}

void keep_only(std::vector<sensors::MountedLidar>& lidars, const std::string& name) {
  const std::string all = sensors::names_of(lidars);
  std::erase_if(lidars, [&](const sensors::MountedLidar& lidar) { return lidar.name != name; });
  if (lidars.empty())
    throw Error("--lidar " + name, "is no lidar of the site",
                all.empty() ? "add it to site.yaml below sensors" : "use one of: " + all);
}

}  // namespace

LogLidars log_lidars(const mapping::Site& site) {
  std::vector<LidarModel> all;
  for (const mapping::SensorRecord& sensor : site.sensors) all.push_back(lidar_model(sensor));
  if (!all.empty()) return LogLidars(std::move(all));
  sensors::LidarSettings nobody;
  nobody.mounting = {0.0, 0.0, 0.0, 0.0};
  return {sensors::lidar_rows().front().model(nobody)};
}

sensors::LogOptions log_options(const mapping::Site& site, const LogArguments& arguments) {
  sensors::LogOptions options;
  options.wheels = arguments.wheels;
  const mapping::VehicleRecord& vehicle = site.vehicle;
  options.geometry = {vehicle.wheel_radius_m, vehicle.wheel_radius_m, vehicle.half_wheel_separation_m};
  options.bag = {
      arguments.scan_topic, arguments.cloud_topic, arguments.odometry_topic, mounted(log_lidars(site)), {}};
  auto& lidars = options.bag.lidars;
  if (!arguments.lidar.empty()) keep_only(lidars, arguments.lidar);
  const auto spinning = std::ranges::find(lidars, false, &sensors::MountedLidar::planar);
  const sensors::MountedLidar& captured = spinning == lidars.end() ? lidars.front() : *spinning;
  options.base_from_lidar = captured.base_from_lidar;
  options.lidar_height_m = captured.height_m;
  options.lidar = captured.place;
  options.remark = [](const std::string& what) { std::fprintf(stderr, "madori: %s\n", what.c_str()); };
  return options;
}

void require_scans(std::size_t scans, const std::string& log) {
  if (scans == 0) throw Error(log, "holds no scan and no cloud", "give a log in which a lidar was recorded");
}

}  // namespace madori::app
