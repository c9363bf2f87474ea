#pragma once

#include <string>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "planning/obstacle_check/vehicle_outline.hpp"
#include "planning/route_graph/route_csv.hpp"

namespace madori::planning {

struct RouteCheckOptions {
  VehicleOutline vehicle;  ///< a leg closer to a wall than half its width is a warning
  std::string tree_file = "tree.csv";
  std::string path_file = "path.csv";
};

/// What is wrong with routes that could be read: legs through drawn walls and stations that cannot be reached
/// or left, and corners that the vehicle's outline does not get round, are errors; places where it cannot
/// turn about on the spot, one-way legs, legs too close to a wall and nodes on one spot are warnings.
[[nodiscard]] std::vector<RouteFinding> check_routes(const RouteGraph& graph,
                                                     const std::vector<Segment2<Map>>& walls,
                                                     const RouteCheckOptions& options = {});

/// The warnings of one-way legs alone.
[[nodiscard]] std::vector<RouteFinding> one_way_warnings(const RouteGraph& graph,
                                                         const std::string& tree_file);

}  // namespace madori::planning
