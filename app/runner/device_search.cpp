#include "app/runner/device_search.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <thread>

#include "app/lidars.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

constexpr auto kListen = std::chrono::milliseconds(2'000);

/// A lidar that is listened for.
struct Candidate {
  std::string type, address;
  std::atomic<int> sweeps = 0;
  std::unique_ptr<sensors::LidarDriver> driver;
};

/// Hosts of the neighbour table.
std::vector<std::string> neighbours() {
  std::vector<std::string> hosts;
  std::ifstream table("/proc/net/arp");
  std::string line;
  std::getline(table, line);  // the head
  while (std::getline(table, line)) {
    std::istringstream words(line);
    std::string host, kind, flags;
    if (words >> host >> kind >> flags && flags != "0x0") hosts.push_back(host);
  }
  return hosts;
}

std::vector<std::string> places_for(const sensors::LidarRow& row) {
  if (row.link == sensors::LidarLink::Serial) return serial_ports();
  std::vector<std::string> places{row.address};
  if (row.link == sensors::LidarLink::Udp) return places;
  const std::string port = row.address.substr(row.address.rfind(':'));
  for (const auto& host : neighbours()) places.push_back(host + port);
  return places;
}

bool is_taken(const sensors::LidarRow& row, const std::string& place,
              const std::vector<mapping::SensorRecord>& taken) {
  return std::ranges::any_of(taken, [&](const auto& sensor) {
    const auto* other = sensors::find_lidar(sensor.type);
    return other != nullptr && other->link == row.link &&
           same_address(row.link, sensor.address.empty() ? other->address : sensor.address, place);
  });
}

/// Opens it; null where its port is taken or it cannot be.
std::unique_ptr<Candidate> listen(const sensors::LidarRow& row, const std::string& place) {
  auto candidate = std::make_unique<Candidate>();
  candidate->type = row.type;
  candidate->address = place;
  mapping::SensorRecord record;
  record.name = row.type;
  record.type = row.type;
  record.address = place;
  try {
    candidate->driver = row.open(lidar_settings(record),
                                 [one = candidate.get()](sensors::LidarSweep&) { ++one->sweeps; }, {});
  } catch (const std::exception&) {
    return nullptr;
  }
  return candidate;
}

void take_answers(const std::vector<std::unique_ptr<Candidate>>& candidates,
                  std::vector<AnsweringDevice>& found) {
  std::this_thread::sleep_for(kListen);
  for (const auto& candidate : candidates)
    if (candidate->sweeps > 0)
      found.push_back({candidate->type, candidate->address,
                       candidate->sweeps / std::chrono::duration<double>(kListen).count()});
}

bool answers_as_drive(const std::string& port) {
  std::atomic<int> statuses = 0;
  const control::DriveLink link({.device = port},
                                [&](const control::wire::Status&, Duration) { ++statuses; });
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  return statuses > 0;
}

}  // namespace

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

std::vector<AnsweringDevice> search_devices(const std::vector<mapping::SensorRecord>& taken,
                                            const std::string& drive_device) {
  using sensors::LidarLink;
  std::vector<AnsweringDevice> found;
  for (const LidarLink link : {LidarLink::Udp, LidarLink::Serial}) {  // UDP and TCP at once
    std::vector<std::unique_ptr<Candidate>> candidates;
    for (const auto& row : sensors::lidar_rows()) {
      if ((row.link == LidarLink::Serial) != (link == LidarLink::Serial)) continue;
      for (const auto& place : places_for(row))
        if (!is_taken(row, place, taken) &&
            !(link == LidarLink::Serial && same_address(link, place, drive_device)))
          if (auto candidate = listen(row, place)) candidates.push_back(std::move(candidate));
    }
    if (!candidates.empty()) take_answers(candidates, found);
  }
  for (const auto& port : serial_ports()) {
    const auto is_it = [&](const std::string& other) { return same_address(LidarLink::Serial, port, other); };
    const bool known = is_it(drive_device) ||
                       std::ranges::any_of(found, [&](const auto& f) { return is_it(f.address); }) ||
                       std::ranges::any_of(taken, [&](const auto& s) { return is_it(s.address); });
    if (!known && answers_as_drive(port)) found.push_back({"drive", port, 0.0});
  }
  return found;
}

}  // namespace madori::app
