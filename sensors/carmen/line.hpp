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

/// What a log's PARAM lines say of its lasers; 0 where they do not.
struct LogParams {
  struct Laser {
    double fov_rad = 0.0, step_rad = 0.0;
  };
  Laser front, rear;
  double front_ahead_m = 0.0;  ///< of the Base: CARMEN's robot_frontlaser_offset

  /// Takes note of a line, where it is a PARAM that matters here.
  void take(std::string_view line);
};

/// One line of a CARMEN log, without its line end. Nothing for comments, empty lines and messages of other
/// kinds (PARAM, SYNC, NMEA ...); a failure for a damaged line. Metres, radians, seconds
/// (docs/reference/logs.md). base_from_lidar is the identity, for RLASER half a turn, for RAWLASER1 as
/// `params` say, which also say the angles of a half-circle laser whose number of beams does not.
[[nodiscard]] Result<std::optional<ParsedLine>> parse_line(std::string_view line,
                                                           const LogParams& params = {});

}  // namespace madori::sensors::carmen
