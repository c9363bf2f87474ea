#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "mapping/wall_map/wall.hpp"
#include "planning/route_graph/route_graph.hpp"
#include "tests/support/bent_plan.hpp"

namespace madori::test {

/// A made-up building and how wrong its drawing is. Every chance is drawn from the seed.
struct BentBuildingOptions {
  std::uint32_t seed = 1;
  BuildingKind kind = BuildingKind::Office;
  bool symmetric = false;         ///< the plan looks the same after half a turn
  bool straight_drawing = false;  ///< the drawing straight and the building bent, else the other way round
  double amplitude_m = 0.3;       ///< largest displacement of the smooth field, metres
  double shortest_wave_m = 5.0;
  double longest_wave_m = 30.0;
  double most_strain = 0.25;  ///< largest slope of the field; the shortest waves give way to it
  double scale = 1.0;         ///< metres of the drawing a metre of the building
  double room_sigma_m = 0.0;  ///< of the shifts of rooms, racks and machines on the drawing, an axis
  double missing = 0.0;       ///< share of the walls that are not drawn
  double invented = 0.0;      ///< drawn walls that do not stand, as a share of those that do
  double furniture = 0.0;     ///< share of the walls that something stands in front of, not drawn
  double clearance_m = 0.75;  ///< of the routes from everything, drawn or true
};

/// What the issue asks for: 15 % missing, 10 % invented; scale within 2 %, rooms shifted by up to 0.3 m and
/// furniture in front of up to 40 % of the walls, drawn from the seed; kind and symmetry by the seed.
[[nodiscard]] BentBuildingOptions hard_building(std::uint32_t seed, double amplitude_m);

/// The known warp between the drawing and the building.
class TrueWarp {
 public:
  explicit TrueWarp(const BentBuildingOptions& options, double width_m, double height_m, std::uint32_t seed);
  [[nodiscard]] Point2<Building> building(const Point2<Map>& p) const;
  [[nodiscard]] Point2<Map> map(const Point2<Building>& p) const;
  /// Largest displacement of the field over the plan, and its largest slope (after the limits).
  [[nodiscard]] double largest_m() const { return largest_m_; }
  [[nodiscard]] double most_strain() const { return most_strain_; }

 private:
  struct Wave {
    double kx, ky, phase, ax, ay;
  };
  [[nodiscard]] Point2<Map> shift(double x_m, double y_m) const;
  void normalize(const BentBuildingOptions& options, double width_m, double height_m);

  std::vector<Wave> waves_;
  double scale_ = 1.0;
  bool direct_to_building_ = false;
  double largest_m_ = 0.0;
  double most_strain_ = 0.0;
};

/// How a drawn wall compares with the building.
struct DrawnWall {
  bool invented = false;
  Point2<Map> shift;  ///< of the room on the drawing, beside the smooth field, metres
};

struct BentBuilding {
  BentBuildingOptions options;
  double width_m = 0.0;  ///< of the plan; the drawing is as large but for bend and scale
  double height_m = 0.0;
  mapping::Walls truth;      ///< what stands, furniture too; Building metres (typed Map as walls are)
  mapping::Walls furniture;  ///< the part of `truth` that is furniture
  mapping::Walls drawn;      ///< the drawing's walls, Map
  std::vector<DrawnWall> drawn_walls;  ///< one a drawn wall
  std::shared_ptr<const TrueWarp> warp;
  planning::RouteGraph routes;   ///< Map; free of walls by the clearance, drawn and true
  std::vector<std::size_t> lap;  ///< nodes of a way around most of the building, neighbours by legs
};

[[nodiscard]] BentBuilding bent_building(const BentBuildingOptions& options);

/// Points `step_m` apart along the lap, `metres` long at most (the lap again and again), Map.
[[nodiscard]] std::vector<Point2<Map>> along_lap(const BentBuilding& building, double step_m, double metres);

}  // namespace madori::test
