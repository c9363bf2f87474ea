#include "app/runner/socket_link.hpp"

#include <algorithm>
#include <utility>

#include "app/lidars.hpp"
#include "app/panel/reference_lidar.hpp"
#include "core/result.hpp"

namespace madori::app {
namespace {

constexpr std::size_t kMostStatuses = 200;  ///< a hung cycle must not fill the memory
constexpr std::size_t kMostClouds = 3;
constexpr std::size_t kMostScans = 50;
constexpr std::size_t kMostPackets = 2000;

template <class Item>
void keep_newest(std::vector<Item>& items, std::size_t most) {
  if (items.size() >= most) items.erase(items.begin());
}

const sensors::LidarRow& row_of(const mapping::SensorRecord& sensor) {
  return sensors::lidar_of(sensor.type, "sensor " + sensor.name);
}

mapping::SensorRecord* first_by(std::vector<mapping::SensorRecord>& sensors, sensors::LidarLink link) {
  const auto found = std::ranges::find_if(sensors, [&](const auto& s) { return row_of(s).link == link; });
  return found == sensors.end() ? nullptr : &*found;
}

bool has_field(const mapping::SensorRecord& sensor) {
  return row_of(sensor).has_field;
}

void take_udp(mapping::SensorRecord& sensor, const SocketOptions& options) {
  const SocketOptions usual;
  if (options.lidar_address != usual.lidar_address || options.lidar_port != usual.lidar_port)
    sensor.address = options.lidar_address + ":" + std::to_string(options.lidar_port);
  if (options.lidar_position_port != usual.lidar_position_port)
    sensor.settings["position_port"] = std::to_string(options.lidar_position_port);
}

/// A scanner that the site does not name stops the vehicle and does nothing else.
void take_scanner(std::vector<mapping::SensorRecord>& sensors, const SocketOptions& options) {
  auto scanner = std::ranges::find_if(sensors, has_field);
  if (scanner == sensors.end()) {
    if (options.safety_scanner.empty()) return;
    const auto row = std::ranges::find_if(sensors::lidar_rows(), &sensors::LidarRow::has_field);
    mapping::SensorRecord extra;
    extra.name = "safety scanner";
    extra.type = row->type;
    scanner = sensors.insert(sensors.end(), extra);
  }
  if (!options.safety_scanner.empty()) scanner->address = options.safety_scanner;
  if (options.scanner_baud > 0) scanner->settings["baud"] = std::to_string(options.scanner_baud);
}

}  // namespace

std::vector<mapping::SensorRecord> addressed(std::vector<mapping::SensorRecord> sensors,
                                             const SocketOptions& options) {
  if (auto* udp = first_by(sensors, sensors::LidarLink::Udp)) take_udp(*udp, options);
  if (auto* tcp = first_by(sensors, sensors::LidarLink::Tcp); tcp && !options.network_scanner.empty())
    tcp->address = options.network_scanner;
  take_scanner(sensors, options);
  for (const std::string& text : options.addresses) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const auto found = std::ranges::find(sensors, name, &mapping::SensorRecord::name);
    if (equals == std::string::npos || found == sensors.end())
      throw Error("--sensor " + text, "names no sensor of the site", "write NAME=ADDRESS");
    found->address = text.substr(equals + 1);
  }
  return sensors;
}

struct SocketLink::OpenLidar {
  mapping::SensorRecord sensor;
  bool has_field = false;
  std::unique_ptr<sensors::LidarDriver> driver;
};

SocketLink::SocketLink(const SocketOptions& options, const WheelGeometry& wheels,
                       const std::vector<mapping::SensorRecord>& sensors)
    : options_(options), wheels_(wheels) {
  drive_ = std::make_unique<control::DriveLink>(control::DriveLinkOptions{.device = options.drive_device},
                                                [this](const control::wire::Status& status, Duration behind) {
                                                  const std::scoped_lock lock(mutex_);
                                                  keep_newest(statuses_, kMostStatuses);
                                                  statuses_.push_back(status);
                                                  drive_behind_ = behind;
                                                });
  set_sensors(sensors);
}

SocketLink::~SocketLink() = default;

void SocketLink::take_sweep(std::size_t lidar, sensors::LidarSweep& sweep) {
  const std::scoped_lock lock(mutex_);
  if (auto* scan = std::get_if<LaserScan>(&sweep.seen)) {
    keep_newest(scans_, kMostScans);
    scans_.push_back(std::move(*scan));
    scans_.back().lidar = lidar;
    return;
  }
  keep_newest(clouds_, kMostClouds);
  keep_newest(firings_us_, kMostClouds);
  clouds_.push_back(std::move(std::get<PointCloud<Lidar>>(sweep.seen)));
  clouds_.back().lidar = lidar;
  firings_us_.push_back(sweep.device_us);
}

void SocketLink::take_bytes(std::size_t lidar, std::span<const std::uint8_t> bytes, Stamp received) {
  const std::scoped_lock lock(mutex_);
  if (packets_.size() < kMostPackets) packets_.push_back({received, {bytes.begin(), bytes.end()}, lidar});
}

void SocketLink::set_sensors(const std::vector<mapping::SensorRecord>& sensors) {
  const std::vector<mapping::SensorRecord> site = sensors.empty() ? std::vector{reference_lidar()} : sensors;
  const auto wanted = addressed(site, options_);
  if (wanted == sensors_) return;
  const std::scoped_lock changing(drivers_mutex_);
  drivers_.clear();  // their threads end here: nothing of the old ones comes later
  sensors_.clear();
  {
    const std::scoped_lock lock(mutex_);
    clouds_.clear(), scans_.clear(), firings_us_.clear(), packets_.clear();
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto& row = row_of(wanted[i]);
    auto lidar = std::make_unique<OpenLidar>(OpenLidar{wanted[i], row.has_field, nullptr});
    const bool drives = i < site.size();
    lidar->driver = row.open(
        lidar_settings(wanted[i]),
        [this, i, drives](sensors::LidarSweep& sweep) {
          if (drives) take_sweep(i, sweep);
        },
        row.keeps_bytes && drives ? [this, i](std::span<const std::uint8_t> bytes,
                                              Stamp received) { take_bytes(i, bytes, received); }
                                  : sensors::BytesTap());
    drivers_.push_back(std::move(lidar));
  }
  sensors_ = wanted;
}

void SocketLink::collect(CycleInput& input) {
  {
    const std::scoped_lock lock(mutex_);
    input.drive = std::exchange(statuses_, {});
    input.drive_behind = drive_behind_;
    input.clouds = std::exchange(clouds_, {});
    input.scans = std::exchange(scans_, {});
    input.firings_us = std::exchange(firings_us_, {});
    input.packets = std::exchange(packets_, {});
  }
  input.protective_stop = std::ranges::any_of(
      drivers_, [](const auto& lidar) { return lidar->has_field && !lidar->driver->health().stop.empty(); });
}

void SocketLink::send(const CycleOutput& output) {
  drive_->send(control::wheel_speeds(wheels_, output.command), output.enable);
}

std::string SocketLink::problem() const {
  const std::scoped_lock lock(drivers_mutex_);
  if (const auto drive = drive_->problem(); !drive.empty()) return "drive: " + drive;
  const auto lidars = std::ranges::count_if(drivers_, [](const auto& l) { return !l->has_field; });
  for (const auto& lidar : drivers_) {
    const std::string what = lidar->driver->health().problem;
    if (what.empty()) continue;
    if (lidar->has_field) return "safety scanner: " + what;
    return (lidars > 1 ? "lidar " + lidar->sensor.name : std::string("lidar")) + ": " + what;
  }
  return "";
}

std::uint16_t SocketLink::lidar_port() const {
  for (const auto& lidar : drivers_)
    if (row_of(lidar->sensor).link == sensors::LidarLink::Udp) return lidar->driver->port();
  return 0;
}

std::vector<LidarState> SocketLink::lidars() const {
  const std::scoped_lock lock(drivers_mutex_);
  std::vector<LidarState> all;
  for (const auto& lidar : drivers_)
    all.push_back({lidar->sensor, lidar->driver->place(), lidar->driver->health()});
  return all;
}

}  // namespace madori::app
