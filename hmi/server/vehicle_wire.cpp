#include "hmi/server/vehicle_wire.hpp"

#include <nlohmann/json.hpp>
#include <string>

namespace madori::hmi {
namespace {

using nlohmann::json;

/// Text that stands in one line of YAML.
std::string one_line(std::string text) {
  std::erase_if(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == '"' || c == '\\'; });
  return text;
}

}  // namespace

json to_wire(const mapping::VehicleRecord& v) {
  json wire;
  for (const auto& field : mapping::kVehicleFields) wire[field.name] = v.*field.value;
  return wire;
}

mapping::VehicleRecord vehicle_from(const json& wire) {
  mapping::VehicleRecord v;
  for (const auto& field : mapping::kVehicleFields) v.*field.value = wire.at(field.name).get<double>();
  return v;
}

/// What the panel does not show of a sensor stays as it was in the site.
std::vector<mapping::SensorRecord> sensors_from(const json& wire,
                                                const std::vector<mapping::SensorRecord>& before) {
  std::vector<mapping::SensorRecord> sensors;
  for (const auto& s : wire) {
    sensors.push_back({one_line(s.at("name").get<std::string>()), one_line(s.at("type").get<std::string>()),
                       s.at("x_m").get<double>(), s.at("y_m").get<double>(), s.at("z_m").get<double>(),
                       s.at("yaw_deg").get<double>()});
    for (const auto& old : before)
      if (old.name == sensors.back().name && old.type == sensors.back().type) {
        sensors.back().protective_m = old.protective_m;
        sensors.back().protective_side_m = old.protective_side_m;
        sensors.back().address = old.address;
        sensors.back().settings = old.settings;
      }
    if (const auto address = s.find("address"); address != s.end())
      sensors.back().address = one_line(address->get<std::string>());
  }
  return sensors;
}

}  // namespace madori::hmi
