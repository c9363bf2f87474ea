#pragma once

#include <filesystem>
#include <string>

#include "app/runner/socket_link.hpp"

namespace madori::app {

struct DeviceRunOptions {
  std::filesystem::path site;
  SocketOptions devices;
  bool resume = false;  ///< the operator has looked around: drive at once
  bool record = true;
  std::string hmi = "off";             ///< HOST:PORT of the touch panel
  std::filesystem::path panel_folder;  ///< where the built page lies
  std::string camera;                  ///< of the panel, instead of the site's
  double duration_s = 0.0;             ///< 0: until interrupted
  std::filesystem::path cycle_times;   ///< where what each step took is written at the end; empty: nowhere
};

/// Drives the vehicle of a site on its real devices until SIGINT, SIGTERM, or the duration is over. Returns
/// the folder of the recording, empty where none was made.
std::filesystem::path run_on_devices(const DeviceRunOptions& options);

}  // namespace madori::app
