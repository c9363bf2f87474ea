#pragma once

#include <cstddef>
#include <vector>

#include "core/path.hpp"
#include "core/result.hpp"
#include "planning/obstacle_check/path_check.hpp"

namespace madori::planning {

struct ManoeuvreOptions {
  double turning_radius_m = 0.45;
  double speed_mps = 0.15;
  double step_m = 0.1;                  ///< of a straight stroke, and of the lattice
  int headings = kCheckedHeadings / 2;  ///< of the lattice, evenly, the vehicle's own first
  double room_m = 2.5;                  ///< searched around the box of start and goals
  double backward_cost = 1.5;           ///< of a metre, in metres forward
  double change_cost_m = 0.3;           ///< of a change between forward, backward and turning
  double turn_cost_m = 0.1;             ///< of a turn on the spot from one heading to the next
  double other_heading_cost_m = 0.3;    ///< of a radian at the route's end beside the route's heading
  double near_m = 0.07;                 ///< of a goal: there
  std::size_t most_nodes = 30'000;      ///< bounds the search
};

struct Manoeuvre {
  Path path;             ///< from `start` to the pose of goal `goal`, which it ends before by at most near_m
  std::size_t goal = 0;  ///< index of the goal that was reached
};

/// A pose that would do, and what the way from there on costs, in metres.
struct ManoeuvreGoal {
  Transform2<Map, Base> pose;
  double rest_m = 0.0;
};

/// A way out of a narrow place: forward, backward and turns on the spot, by A* over a lattice of poses
/// (Pivtoraiko, Knepper and Kelly, Journal of Field Robotics 26, 2009, with positions kept as they are as in
/// hybrid A*). Each move, and the last turn into the goal's heading, is checked as check_path() does at this
/// speed. Fails where none is found within most_nodes. Deterministic.
[[nodiscard]] Result<Manoeuvre> find_manoeuvre(const Transform2<Map, Base>& start,
                                               const std::vector<ManoeuvreGoal>& goals,
                                               const std::vector<Point2<Map>>& obstacles,
                                               const WallGrid& walls, const CheckOptions& check,
                                               const ManoeuvreOptions& options = {});

}  // namespace madori::planning
