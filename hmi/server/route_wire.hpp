#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "planning/route_graph/route_csv.hpp"

namespace madori::hmi {

/// A RoutesEdit as a graph. Throws Error on unknown or doubled IDs and on numbers that are not finite.
[[nodiscard]] planning::RouteGraph graph_from_wire(const nlohmann::json& edit);
/// Routes of hmi/schema: nodes, legs and the findings.
[[nodiscard]] nlohmann::json routes_to_wire(const planning::RouteGraph& graph,
                                            const std::vector<planning::RouteFinding>& findings,
                                            const std::string& revision);

}  // namespace madori::hmi
