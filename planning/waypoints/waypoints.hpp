#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/path.hpp"
#include "core/result.hpp"

namespace madori::planning {

/// Waypoints nearer together than this are one place, rounded: there the vehicle turns on the spot.
inline constexpr double kSamePointM = 1e-6;

/// A path of more is refused: 200 km at the usual spacing, 100 MB.
inline constexpr double kMostWaypoints = 2e6;

/// A corner of the way, with what holds on the leg that leads to it.
struct WayCorner {
  Point2<Map> position;
  double speed_limit_mps = std::numeric_limits<double>::infinity();
};

struct WaypointOptions {
  double spacing_m = 0.1;          ///< between waypoints; evened out so that the last one meets the end
  double corner_radius_m = 0.8;    ///< a corner is rounded by at most this radius
  double min_radius_m = 0.35;      ///< a corner that leaves room for less is turned on the spot
  double max_corner_cut_m = 0.25;  ///< how far the rounding may leave the corner
};

/// Waypoints at equal spacing along the way (layout-map paper, section 3.3.2), corners rounded by arcs as far
/// as the vehicle can follow. A turn on the spot is a repeated position with the new heading; so is the final
/// heading, where one is asked for. Fails where there are less than two distinct corners, or more than
/// kMostWaypoints would be needed.
[[nodiscard]] Result<Path> make_waypoints(const std::vector<WayCorner>& way,
                                          const WaypointOptions& options = {},
                                          std::optional<double> final_heading_rad = std::nullopt);

/// A turn on the spot at the end of a path of at least one point.
void end_in(Path& path, double heading_rad);

/// The text of a waypoint file as published, `ID,x,y`; turns on the spot have no row of their own.
[[nodiscard]] std::string waypoints_csv(const Path& path);

}  // namespace madori::planning
