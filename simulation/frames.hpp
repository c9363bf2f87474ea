#pragma once

#include "core/frames.hpp"
#include "core/transform2.hpp"

namespace madori::simulation {

/// The true building, metres on its floor. Where the drawing is right, it differs from the Map frame only by
/// the place that the scenario gives to its own coordinates.
struct Building {};
/// The coordinates in which a scenario file is written, metres on the drawing.
struct Plan {};

/// How the true building, the scenario's coordinates and the drawing hang together.
/// building = (1 + error) * plan per axis; map = map_from_plan * plan.
struct PlanFrames {
  double scale_x = 1.0;  ///< true metres a metre on the drawing
  double scale_y = 1.0;
  Transform2<Map, Plan> map_from_plan;

  [[nodiscard]] Point2<Building> building(const Point2<Plan>& p) const {
    return {p.x_m * scale_x, p.y_m * scale_y};
  }
  [[nodiscard]] Point2<Plan> plan(const Point2<Building>& p) const {
    return {p.x_m / scale_x, p.y_m / scale_y};
  }
  /// A pose on the drawing; directions are stretched like the drawing.
  [[nodiscard]] Transform2<Building, Base> building_pose(const Transform2<Map, Base>& map_from_base) const {
    const Transform2<Plan, Base> p = map_from_plan.inverse() * map_from_base;
    const Point2<Building> at = building(p.translation());
    return {at.x_m, at.y_m, std::atan2(p.sin_yaw() * scale_y, p.cos_yaw() * scale_x)};
  }
  /// Where the vehicle is on the drawing.
  [[nodiscard]] Transform2<Map, Base> map_pose(const Transform2<Building, Base>& pose) const {
    const Point2<Plan> at = plan(pose.translation());
    const double yaw = std::atan2(pose.sin_yaw() / scale_y, pose.cos_yaw() / scale_x);
    return map_from_plan * Transform2<Plan, Base>(at.x_m, at.y_m, yaw);
  }
};

}  // namespace madori::simulation
