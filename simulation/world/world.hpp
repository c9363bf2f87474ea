#pragma once

#include <memory>
#include <vector>

#include "mapping/wall_map/wall.hpp"
#include "simulation/scenario/scenario.hpp"
#include "simulation/world/collision.hpp"
#include "simulation/world/ray_caster.hpp"

namespace madori::simulation {

/// The frame of a ramp: origin at its middle, x uphill.
struct Slope {};

struct Ramp {
  Transform2<Building, Slope> building_from_ramp;
  double half_length_m = 0.0, half_width_m = 0.0, rise_m = 0.0;
};

/// Height and slope of the floor at a place.
struct FloorAt {
  double z_m = 0.0;
  double slope_x = 0.0;  ///< dz/dx, dz/dy
  double slope_y = 0.0;
};

/// Everything of the true factory that never moves.
class World {
 public:
  /// `walls` in the Map frame unless the scenario names its own true walls. Throws Error on a wall number of
  /// the scenario that does not exist. The furniture of a day follows from scenario.seed and furniture.day.
  World(const mapping::Walls& walls, const Scenario& scenario);

  [[nodiscard]] const PlanFrames& frames() const { return frames_; }
  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  [[nodiscard]] const RayCaster& rays() const { return *rays_; }
  [[nodiscard]] const ObstacleIndex& obstacles() const { return obstacles_; }
  /// The true walls, Building frame.
  [[nodiscard]] const std::vector<Segment2<Building>>& walls() const { return walls_; }
  [[nodiscard]] FloorAt floor_at(const Point2<Building>& p) const;

 private:
  void add_wall(const Segment2<Building>& line, double height_m, const std::string& name);
  void add_solid(const SolidSpec& solid);
  void add_office(const OfficeSpec& office);
  void add_ramp(const RampSpec& ramp);
  void add_shell(const BuildingSpec& building);

  PlanFrames frames_;
  std::vector<Segment2<Building>> walls_;
  Mesh mesh_;
  ObstacleIndex obstacles_;
  std::vector<Ramp> ramps_;
  std::unique_ptr<RayCaster> rays_;
};

/// The outline of a rectangle, counter-clockwise.
[[nodiscard]] std::vector<Point2<Building>> rectangle(const Point2<Building>& centre, double yaw_rad,
                                                      double length_m, double width_m);

}  // namespace madori::simulation
