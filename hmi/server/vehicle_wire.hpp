#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "mapping/site/site.hpp"

/// Vehicle and sensors of site.yaml as the panel edits them (VehicleInfo, SensorInfo of hmi/schema).
namespace madori::hmi {

[[nodiscard]] nlohmann::json to_wire(const mapping::VehicleRecord& vehicle);
[[nodiscard]] mapping::VehicleRecord vehicle_from(const nlohmann::json& wire);
/// What the panel does not show of a sensor stays as it was in the site.
[[nodiscard]] std::vector<mapping::SensorRecord> sensors_from(
    const nlohmann::json& wire, const std::vector<mapping::SensorRecord>& before);

}  // namespace madori::hmi
