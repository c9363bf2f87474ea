#pragma once

#include <string>

#include "app/runner/socket_link.hpp"

namespace madori::app {

struct MountingArguments {
  bool wanted = false;
  std::string log;  ///< a recorded run instead of a drive
  bool yes = false;
  bool apply = false;
  std::string json_file;
};

/// `madori doctor DIR --calibrate-mounting`: drives, or reads a recorded run, and prints how each lidar hangs
/// against how it was typed. Throws Error where nothing could be measured.
void calibrate_mountings(const std::string& site, const SocketOptions& devices,
                         const MountingArguments& arguments);

}  // namespace madori::app
