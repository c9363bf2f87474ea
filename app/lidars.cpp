#include "app/lidars.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "core/angle.hpp"
#include "core/result.hpp"

namespace madori::app {
namespace {

/// A bracket may stand out so far.
constexpr double kBracketM = 0.3;
constexpr double kMastM = 4.0;

void check_mounting(const mapping::SensorRecord& s, const mapping::VehicleRecord& v,
                    const std::string& where) {
  const double front_m = v.length_m - v.base_to_rear_m;
  if (s.x_m > front_m + kBracketM || s.x_m < -v.base_to_rear_m - kBracketM ||
      std::abs(s.y_m) > v.width_m / 2.0 + kBracketM)
    throw Error(where, "sensor " + s.name + " is mounted outside the vehicle",
                "give x_m and y_m from the middle between the driven wheels, in metres");
  if (!(s.z_m > 0.0 && s.z_m < v.height_m + kMastM))
    throw Error(where,
                "sensor " + s.name + " hangs " + (s.z_m > 0.0 ? "far above the vehicle" : "in the floor"),
                "give z_m, its height above the floor in metres");
}

std::string address_of(const mapping::SensorRecord& sensor, const sensors::LidarRow& row) {
  return sensor.address.empty() ? row.address : sensor.address;
}

/// Whoever opens the link would find it out only when the vehicle is to drive.
void check_address(const mapping::SensorRecord& sensor, const sensors::LidarRow& row) {
  if (row.link == sensors::LidarLink::Serial) return;
  try {
    (void)sensors::host_and_port(sensor.address, {"", 0});
  } catch (const Error& e) {
    throw Error("sensor " + sensor.name + ": address " + e.what());
  }
}

/// One device cannot be two sensors.
void check_apart(const std::vector<mapping::SensorRecord>& sensors, const std::string& where) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const auto& s = sensors[i];
    if (!names.insert(s.name).second)
      throw Error(where, "two sensors are named " + s.name, "give each its own name");
    const auto& row = sensors::lidar_of(s.type, where);
    const std::string address = address_of(s, row);
    for (std::size_t j = 0; j < i; ++j) {
      const auto& other = sensors::lidar_of(sensors[j].type, where);
      if (other.link == row.link && same_address(row.link, address, address_of(sensors[j], other)))
        throw Error(where, "two sensors have the address " + address,
                    "give each its own below sensors, as address:");
    }
  }
}

}  // namespace

bool same_address(sensors::LidarLink link, const std::string& a, const std::string& b) {
  if (link == sensors::LidarLink::Serial) {
    std::error_code missing;
    const std::filesystem::path first = std::filesystem::canonical(a, missing),
                                second = std::filesystem::canonical(b, missing);
    return a == b || (!first.empty() && first == second);
  }
  const auto first = sensors::host_and_port(a, {"", 0}), second = sensors::host_and_port(b, {"", 0});
  const bool one_port = first.port == second.port || first.port == 0 || second.port == 0;
  return one_port && (link == sensors::LidarLink::Udp || first.host == second.host);
}

sensors::LidarSettings lidar_settings(const mapping::SensorRecord& sensor) {
  return {sensor.name,
          sensor.address,
          {sensor.x_m, sensor.y_m, sensor.z_m, to_rad(sensor.yaw_deg)},
          sensor.settings};
}

std::string lidar_title(const std::string& type) {
  const auto* row = sensors::find_lidar(type);
  return row == nullptr ? "" : row->title;
}

LidarModel lidar_model(const mapping::SensorRecord& sensor) {
  const auto& row = sensors::lidar_of(sensor.type, "sensor " + sensor.name);
  check_address(sensor, row);
  return row.model(lidar_settings(sensor));
}

double sure_ahead_m(const std::vector<LidarModel>& lidars, double front_m) {
  double best_m = 0.0;
  for (const LidarModel& lidar : lidars) best_m = std::max(best_m, planning::sure_ahead_m(lidar, front_m));
  return best_m;
}

double sure_low_m(const std::vector<LidarModel>& lidars, double front_m, double reach_m) {
  double best_m = 0.0;
  for (const LidarModel& lidar : lidars)
    best_m = std::max(best_m, planning::sure_low_m(lidar, front_m, reach_m));
  return best_m;
}

double lowest_ahead_m(const std::vector<LidarModel>& lidars) {
  double lowest_m = std::numeric_limits<double>::infinity();
  for (const LidarModel& lidar : lidars)
    if (planning::SensorView::of(lidar).looks_at(0.0))
      lowest_m = std::min(lowest_m, std::max(0.0, lidar.lowest_m(lidar.range_max_m)));
  return lowest_m;
}

std::vector<LidarModel> lidars_of(const mapping::Site& site, const std::filesystem::path& folder) {
  const std::string where = (folder / "site.yaml").string();
  if (site.sensors.empty())
    throw Error(where, "names no lidar, which the vehicle needs to drive",
                "add one below sensors: with its place on the vehicle");
  std::vector<LidarModel> lidars;
  for (const auto& sensor : site.sensors) {
    (void)sensors::lidar_of(sensor.type, where + ": sensor " + sensor.name);
    check_mounting(sensor, site.vehicle, where);
    const bool field = sensor.protective_m > 0.0 || sensor.protective_side_m > 0.0;
    if (field && !sensors::lidar_of(sensor.type, where).has_field)
      throw Error(where, "sensor " + sensor.name + " has no protective field",
                  "take protective_m and protective_side_m away");
    lidars.push_back(lidar_model(sensor));
  }
  check_apart(site.sensors, where);
  return lidars;
}

std::vector<mapping::SensorRecord> listed_sensors(const std::filesystem::path& site) {
  try {
    const auto sensors = mapping::load_site(site).sensors;
    for (const auto& sensor : sensors) (void)lidar_model(sensor);
    return sensors;
  } catch (const std::exception&) {  // what is wrong is told by who loads the site to drive
    return {};
  }
}

}  // namespace madori::app
