#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/stamp.hpp"
#include "hmi/server/vehicle.hpp"

/// The wire types of hmi/schema/api.schema.json, written by the server. Lengths in metres, angles in radians,
/// Map frame, stamps in seconds since the Unix epoch.
namespace madori::hmi {

[[nodiscard]] nlohmann::json to_wire(const Notice& notice);
/// A Live without what the vehicle does not know: locked, revisions, editors. `now` gives the ages.
[[nodiscard]] nlohmann::json to_wire(const LiveState& live, Stamp now);
[[nodiscard]] nlohmann::json to_wire(const OrderView& order);
[[nodiscard]] nlohmann::json to_wire(const EventView& event);
[[nodiscard]] nlohmann::json to_wire(const StatisticsView& statistics);
[[nodiscard]] nlohmann::json to_wire(const LocateView& locate);
[[nodiscard]] nlohmann::json to_wire(const WallView& wall);
[[nodiscard]] nlohmann::json to_wire(const mapping::SensorRecord& sensor);
[[nodiscard]] nlohmann::json to_wire(const FoundDevice& device);
[[nodiscard]] nlohmann::json to_wire(const LidarView& lidar);
[[nodiscard]] nlohmann::json to_wire(const MountingState& mounting);

/// Text with broken UTF-8 replaced, as JSON wants it.
[[nodiscard]] std::string dump(const nlohmann::json& value);

}  // namespace madori::hmi
