#include "app/panel/found_devices.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>

#include "app/lidars.hpp"
#include "app/panel/reference_lidar.hpp"
#include "app/runner/device_search.hpp"

namespace madori::app {
namespace {

/// Of several devices of a type the one with that number: they come in the site's order.
bool is_heard(const std::vector<hmi::DeviceStatus>& live, const std::string& type, std::size_t number = 0) {
  for (const auto& device : live)
    if (device.type == type && number-- == 0) return device.healthy;
  return false;
}

/// As people say it: a UDP port is this computer's own.
std::string place_of(const mapping::SensorRecord& sensor) {
  const auto* row = sensors::find_lidar(sensor.type);
  if (row == nullptr) return sensor.address;
  const std::string& place = sensor.address.empty() ? row->address : sensor.address;
  return row->link == sensors::LidarLink::Udp ? "UDP " + place.substr(place.rfind(':') + 1) : place;
}

}  // namespace

hmi::Notice heard_or_silent(bool heard) {
  return heard ? hmi::Notice{"heard", {}, "heard"} : hmi::Notice{"silent", {}, "nothing is heard from it"};
}

std::vector<hmi::FoundDevice> found_devices(const SocketOptions& options,
                                            const std::vector<mapping::SensorRecord>& sensors,
                                            const std::vector<hmi::DeviceStatus>& live) {
  const bool drive = is_heard(live, "drive");
  std::vector<hmi::FoundDevice> found;
  const auto site = sensors.empty() ? std::vector{reference_lidar()} : sensors;
  std::map<std::string, std::size_t> numbers;
  for (const auto& sensor : addressed(site, options)) {
    const bool heard = is_heard(live, sensor.type, numbers[sensor.type]++);
    mapping::SensorRecord proposal = sensor;
    proposal.address.clear();
    proposal.settings.clear();
    found.push_back(
        {sensor.type, lidar_title(sensor.type), place_of(sensor), heard, heard_or_silent(heard), proposal});
  }
  found.push_back({"drive", "", options.drive_device, drive, heard_or_silent(drive), std::nullopt});
  for (const auto& port : serial_ports())
    if (std::ranges::none_of(found, [&](const auto& device) { return device.address == port; }))
      found.push_back({"drive",
                       "",
                       port,
                       false,
                       {"unused-port", {{"port", port}}, "not used: start with --drive " + port},
                       std::nullopt});
  return found;
}

std::vector<hmi::FoundDevice> searched_devices(const SocketOptions& options,
                                               const std::vector<mapping::SensorRecord>& sensors) {
  const auto site = sensors.empty() ? std::vector{reference_lidar()} : sensors;
  std::vector<hmi::FoundDevice> found;
  for (const auto& device : search_devices(addressed(site, options), options.drive_device)) {
    const auto* row = sensors::find_lidar(device.type);
    std::optional<mapping::SensorRecord> proposal;
    if (row != nullptr) {
      proposal = reference_lidar();
      proposal->type = device.type;
      proposal->name = device.type + " " + std::to_string(found.size() + 1);
      if (device.address != row->address) proposal->address = device.address;
    }
    found.push_back(
        {device.type, lidar_title(device.type), device.address, true, heard_or_silent(true), proposal});
  }
  return found;
}

}  // namespace madori::app
