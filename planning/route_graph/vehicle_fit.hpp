#pragma once

#include <cstddef>
#include <vector>

#include "core/path.hpp"
#include "planning/obstacle_check/path_check.hpp"
#include "planning/route_graph/route_graph.hpp"
#include "planning/waypoints/waypoints.hpp"

namespace madori::planning {

/// Of a vehicle's record (mapping::VehicleRecord).
template <class Record>
[[nodiscard]] VehicleOutline outline_of(const Record& v) {
  return {v.length_m - v.base_to_rear_m, v.base_to_rear_m, v.width_m / 2.0, v.height_m};
}

/// What a drawn wall blocks of a path for the bare outline, without any margin. A wall within 0.1 m of the
/// outline's edge does not count: a drawing may be off by so much, and the vehicle squeezes by.
[[nodiscard]] PathCheck check_fit(const Path& path, const WallGrid& walls, const VehicleOutline& vehicle);

/// A corner of the routes that the vehicle's outline does not get round, drawn walls as they are.
struct TightCorner {
  std::size_t from = 0, node = 0, to = 0;  ///< from == to: it would turn about there
  Point2<Map> wall;                        ///< what it would meet
};

/// Every corner of the routes as it is driven: rounded, or turned on the spot; turning about at stations and
/// dead ends, and into the heading that a station asks for, too.
[[nodiscard]] std::vector<TightCorner> tight_corners(const RouteGraph& graph, const WallGrid& walls,
                                                     const VehicleOutline& vehicle,
                                                     const WaypointOptions& options = {});

}  // namespace madori::planning
