#pragma once

#include <vector>

#include "tests/bench/wall_training/plan_canvas.hpp"

namespace madori::training {

struct Opening {
  double from = 0, to = 0;  ///< metres along the wall
  bool window = false;
};

struct PlanWall {
  Point a, b;
  bool outer = false, light = false;
  std::vector<Opening> openings;  ///< in order, apart

  [[nodiscard]] double length() const { return cv::norm(b - a); }
  [[nodiscard]] Point at(double metres) const { return a + (b - a) * (metres / length()); }
};

/// A wing of a building: a rectangle of rooms, in metres from its own corner.
struct Wing {
  double width = 0, height = 0;
  std::vector<Box> rooms;
  std::vector<PlanWall> walls;
};

/// Rooms by splitting, with or without a corridor, with doors that stand clear of walls that meet theirs.
[[nodiscard]] Wing random_wing(const PlanStyle& style, double width, double height, Chance& chance);

}  // namespace madori::training
