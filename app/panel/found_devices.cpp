#include "app/panel/found_devices.hpp"

#include <algorithm>
#include <filesystem>
#include <string>

#include "app/panel/reference_lidar.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

bool is_heard(const std::vector<hmi::DeviceStatus>& live, const std::string& type) {
  return std::ranges::any_of(live, [&](const auto& d) { return d.type == type && d.healthy; });
}

hmi::Notice heard_or_silent(bool heard) {
  return heard ? hmi::Notice{"heard", {}, "heard"} : hmi::Notice{"silent", {}, "nothing is heard from it"};
}

/// Serial adapters by the names that udev gives them, which stay when they are plugged in elsewhere.
std::vector<std::string> serial_ports() {
  std::vector<std::string> ports;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator("/dev/serial/by-id", missing))
    ports.push_back(entry.path().string());
  for (const auto& entry : fs::directory_iterator("/dev", missing)) {
    const std::string name = entry.path().filename().string();
    if (ports.empty() && (name.starts_with("ttyUSB") || name.starts_with("ttyACM")))
      ports.push_back(entry.path().string());
  }
  std::ranges::sort(ports);
  return ports;
}

}  // namespace

std::vector<hmi::FoundDevice> found_devices(const SocketOptions& options,
                                            const std::vector<hmi::DeviceStatus>& live) {
  const bool lidar = is_heard(live, "vlp16");
  const bool drive = is_heard(live, "drive");
  std::vector<hmi::FoundDevice> found{
      {"vlp16", "UDP " + std::to_string(options.lidar_port), lidar, heard_or_silent(lidar), kReferenceLidar},
      {"drive", options.drive_device, drive, heard_or_silent(drive), std::nullopt}};
  for (const auto& port : serial_ports())
    if (port != options.drive_device && port != options.safety_scanner)
      found.push_back({"drive",
                       port,
                       false,
                       {"unused-port", {{"port", port}}, "not used: start with --drive " + port},
                       std::nullopt});
  return found;
}

}  // namespace madori::app
