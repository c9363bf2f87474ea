#pragma once

#include <string>

#include "planning/obstacle_check/moving_objects.hpp"
#include "simulation/world/body.hpp"

namespace madori::bench {

using simulation::Building;

enum class Traffic { Person, Truck };  ///< Truck: a forklift or a tugger

/// A body of the virtual factory that is no part of the building, at the moment of a scan.
struct TrueMover {
  std::string name;
  Traffic kind = Traffic::Person;
  simulation::Body body;
  double vx_mps = 0.0, vy_mps = 0.0;  ///< Building frame
  double range_m = 0.0;               ///< from the lidar to the nearest point of its outline
  bool moves = false;                 ///< has moved within the last second: who tells of it is right
  bool asked = false;                 ///< moves and is in plain sight: it has to be found
};

/// What somebody tells to move.
using ToldMover = planning::Mover<Building>;

}  // namespace madori::bench
