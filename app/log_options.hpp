#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/lidar_model.hpp"
#include "mapping/site/site.hpp"
#include "sensors/open_log.hpp"

namespace madori::app {

/// What a person says of a log. All may be empty.
struct LogArguments {
  std::string wheels;  ///< CSV, beside a capture
  std::string scan_topic, cloud_topic, odometry_topic;
  std::string lidar;  ///< a sensor of site.yaml: whose the scans and clouds are
};

/// The lidars that a log may tell of; never none.
struct LogLidars {
  LogLidars(LidarModel only) { all.push_back(std::move(only)); }  // NOLINT(google-explicit-constructor)
  explicit LogLidars(std::vector<LidarModel> models) : all(std::move(models)) {}

  /// The one of that place, which a record names.
  [[nodiscard]] const LidarModel& at(std::size_t place) const { return all[std::min(place, all.size() - 1)]; }

  std::vector<LidarModel> all;
};

/// Those of the site's vehicle, by their places in site.yaml. Where it names none, one of the first kind of
/// the registry at the Base origin, on the floor.
[[nodiscard]] LogLidars log_lidars(const mapping::Site& site);
/// How a log of this site's vehicle is read: its wheels, and its lidars' mountings. A capture is of its first
/// lidar that makes clouds. Throws Error where no lidar is called as the arguments say.
[[nodiscard]] sensors::LogOptions log_options(const mapping::Site& site, const LogArguments& arguments = {});

/// Throws Error where a log that was read to its end held neither a scan nor a cloud.
void require_scans(std::size_t scans, const std::string& log);

}  // namespace madori::app
