#pragma once

#include <filesystem>
#include <vector>

#include "core/lidar_model.hpp"
#include "mapping/site/site.hpp"
#include "planning/obstacle_check/sure_sight.hpp"
#include "sensors/lidar/registry.hpp"

namespace madori::app {

/// A sensor of site.yaml as its driver wants it.
[[nodiscard]] sensors::LidarSettings lidar_settings(const mapping::SensorRecord& sensor);
/// The product's name for people; empty where no lidar is called so.
[[nodiscard]] std::string lidar_title(const std::string& type);
/// What that sensor sees, by its kind and its mounting. Throws Error on an unknown kind or setting.
[[nodiscard]] LidarModel lidar_model(const mapping::SensorRecord& sensor);
/// Whether two addresses of that kind of link mean one device: the same UDP port, host or serial port.
[[nodiscard]] bool same_address(sensors::LidarLink link, const std::string& a, const std::string& b);

/// The lidars of a site in its order. Throws an Error that names `folder`/site.yaml: none at all, an unknown
/// kind, two of one name or address, one that is mounted outside the vehicle.
[[nodiscard]] std::vector<LidarModel> lidars_of(const mapping::Site& site,
                                                const std::filesystem::path& folder);

/// The sensors that a site lists, whether it can be driven or not; nothing where there is no site, or one
/// that nobody knows.
[[nodiscard]] std::vector<mapping::SensorRecord> listed_sensors(const std::filesystem::path& site);

using planning::kLegM;
/// How far before the vehicle's front a leg is sure to be seen: by the lidar that does it best straight
/// ahead.
[[nodiscard]] double sure_ahead_m(const std::vector<LidarModel>& lidars, double front_m);

using planning::kLyingM;
/// How far before the vehicle's front who lies on the floor is sure to have been seen, likewise; 0 where all
/// look over him.
[[nodiscard]] double sure_low_m(const std::vector<LidarModel>& lidars, double front_m, double reach_m);
/// The lowest height above the floor that a lidar sees straight ahead, somewhere before the vehicle; infinity
/// where none looks ahead.
[[nodiscard]] double lowest_ahead_m(const std::vector<LidarModel>& lidars);

}  // namespace madori::app
