#pragma once

#include <filesystem>

#include "mapping/site/site.hpp"
#include "sensors/open_log.hpp"

namespace madori::app {

/// How a log of this site's vehicle is read: its wheels, and the mounting of its first lidar (at the Base
/// origin where the site names none). `wheels` may be empty.
[[nodiscard]] sensors::LogOptions log_options(const mapping::Site& site,
                                              const std::filesystem::path& wheels = {});

}  // namespace madori::app
