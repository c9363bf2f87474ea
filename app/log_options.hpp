#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "core/lidar_model.hpp"
#include "mapping/site/site.hpp"
#include "sensors/open_log.hpp"

namespace madori::app {

/// The lidar whose log this site's vehicle records: its first one without a protective field. Where the site
/// names none, the first kind of the registry at the Base origin, on the floor.
[[nodiscard]] LidarModel log_lidar(const mapping::Site& site);
/// How a log of this site's vehicle is read: its wheels, and the mounting of that lidar. `wheels` may be
/// empty.
[[nodiscard]] sensors::LogOptions log_options(const mapping::Site& site,
                                              const std::filesystem::path& wheels = {});

/// Throws Error where a log that was read to its end held neither a scan nor a cloud.
void require_scans(std::size_t scans, const std::string& log);

}  // namespace madori::app
