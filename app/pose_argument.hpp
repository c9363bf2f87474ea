#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <sstream>
#include <string>

#include "core/angle.hpp"
#include "core/frames.hpp"
#include "core/transform2.hpp"

namespace madori::app {

/// "x y yaw_deg" of the command line, metres and degrees. Throws CLI::ValidationError with the option's name.
inline Transform2<Map, Base> parse_pose(const std::string& option, const std::string& text) {
  std::istringstream words(text);
  double x = 0.0;
  double y = 0.0;
  double yaw_deg = 0.0;
  std::string rest;
  if (!(words >> x >> y >> yaw_deg) || words >> rest || !std::isfinite(x + y + yaw_deg)) {
    throw CLI::ValidationError(option, "'" + text + "' is not \"x y yaw_deg\"");
  }
  return {x, y, to_rad(yaw_deg)};
}

}  // namespace madori::app
