#pragma once

#include "simulation/factory.hpp"

namespace madori::test {

/// A rectangular hall from the origin to (length, width) in which a vehicle stands at (x, y, yaw), quiet:
/// perfect lidars, no slip.
inline simulation::FactorySetup small_hall(double length_m = 20.0, double width_m = 12.0, double x_m = 5.0,
                                           double y_m = 4.0, double yaw_rad = 0.0) {
  simulation::FactorySetup setup;
  const Point2<Map> a{0.0, 0.0}, b{length_m, 0.0}, c{length_m, width_m}, d{0.0, width_m};
  setup.walls = {{1, {a, b}}, {2, {b, c}}, {3, {c, d}}, {4, {d, a}}};
  setup.scenario.name = "small hall";
  setup.scenario.start = {x_m, y_m, yaw_rad};
  setup.scenario.vehicle.slip_noise = 0.0;
  for (simulation::LidarErrors* errors : {static_cast<simulation::LidarErrors*>(&setup.scenario.vlp16),
                                          static_cast<simulation::LidarErrors*>(&setup.scenario.lms1xx),
                                          static_cast<simulation::LidarErrors*>(&setup.scenario.s300)})
    *errors = {};
  return setup;
}

}  // namespace madori::test
