#pragma once

#include <filesystem>

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

}  // namespace madori::app
