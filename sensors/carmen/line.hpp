#pragma once

#include <optional>
#include <string_view>

#include "core/result.hpp"
#include "sensors/log_record.hpp"

namespace madori::sensors::carmen {

/// A record and the laser's pose as the line states it (FLASER, RLASER, ROBOTLASER1).
struct ParsedLine {
  LogRecord record;
  std::optional<Transform2<Odom, Lidar>> odom_from_lidar;
};

/// One line of a CARMEN log, without its line end. Nothing for comments, empty lines and messages of other
/// kinds (PARAM, SYNC, NMEA ...); a failure for a damaged line. Metres, radians, seconds
/// (docs/reference/logs.md). base_from_lidar is the identity, for RLASER half a turn.
[[nodiscard]] Result<std::optional<ParsedLine>> parse_line(std::string_view line);

}  // namespace madori::sensors::carmen
