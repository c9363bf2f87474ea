#pragma once

#include <memory>

#include "planning/route_graph/route_csv.hpp"
#include "tests/support/toy_vehicle.hpp"

namespace madori::test {

/// A vehicle at node 0, heading along a long corridor 0 - 1 - 2 (x = 0, 10 and 22 m), with a loop 1 - 3 - 2
/// beside it.
inline std::unique_ptr<ToyVehicle> corridor_vehicle() {
  auto routes = planning::parse_routes("ID,EDA\n0,1\n1,0 2 3\n2,1 3\n3,1 2\n",
                                       "ID,x,y,heading_deg\n0,0,0,\n1,10,0,\n2,22,0,90\n3,16,6,\n");
  return std::make_unique<ToyVehicle>(toy_config(std::move(routes.graph)),
                                      Transform2<Map, Base>(0.0, 0.0, 0.0));
}

}  // namespace madori::test
