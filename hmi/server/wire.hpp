#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "core/stamp.hpp"
#include "hmi/server/vehicle.hpp"

/// The wire types of hmi/schema/api.schema.json, written by the server. Lengths in metres, angles in radians,
/// Map frame, stamps in seconds since the Unix epoch.
namespace madori::hmi {

[[nodiscard]] nlohmann::json to_wire(const Notice& notice);
/// Everything but the scan, which goes as `scan_frame`. `now` gives the age of every value.
[[nodiscard]] nlohmann::json to_wire(const LiveState& live, Stamp now);
[[nodiscard]] nlohmann::json to_wire(const OrderView& order);
[[nodiscard]] nlohmann::json to_wire(const EventView& event);
[[nodiscard]] nlohmann::json to_wire(const StatisticsView& statistics);

/// Text with broken UTF-8 replaced, as JSON wants it.
[[nodiscard]] std::string dump(const nlohmann::json& value);

/// Binary frame of a scan: "MDS1", u32 count, then count pairs of f32 (x, y) in metres, Map frame;
/// little-endian.
[[nodiscard]] std::string scan_frame(std::span<const Point2<Map>> scan);

}  // namespace madori::hmi
