#pragma once

#include <random>
#include <vector>

#include "core/transform2.hpp"
#include "mapping/wall_map/distance_field.hpp"
#include "mapping/wall_map/wall.hpp"
#include "tests/support/ray_caster.hpp"

namespace madori::test {

inline void add_wall(mapping::Walls& walls, double x1, double y1, double x2, double y2) {
  walls.push_back({static_cast<int>(walls.size()), {{x1, y1}, {x2, y2}}});
}
/// The outline of a column, machine or room.
inline void add_box(mapping::Walls& walls, double x1, double y1, double x2, double y2) {
  add_wall(walls, x1, y1, x2, y1);
  add_wall(walls, x2, y1, x2, y2);
  add_wall(walls, x2, y2, x1, y2);
  add_wall(walls, x1, y2, x1, y1);
}

/// A laboratory hall of 20 m x 10 m with machines, tables and an alcove, after the description in Kis et al.
inline mapping::Walls laboratory_hall() {
  mapping::Walls walls;
  add_wall(walls, 0.0, 0.0, 14.0, 0.0);
  add_wall(walls, 14.0, 0.0, 14.0, -1.2);  // alcove of the gate
  add_wall(walls, 14.0, -1.2, 17.0, -1.2);
  add_wall(walls, 17.0, -1.2, 17.0, 0.0);
  add_wall(walls, 17.0, 0.0, 20.0, 0.0);
  add_wall(walls, 20.0, 0.0, 20.0, 10.0);
  add_wall(walls, 20.0, 10.0, 6.5, 10.0);
  add_wall(walls, 6.5, 10.0, 6.5, 8.4);
  add_wall(walls, 6.5, 8.4, 0.0, 8.4);
  add_wall(walls, 0.0, 8.4, 0.0, 0.0);
  add_box(walls, 3.0, 2.2, 5.4, 3.6);      // conveyor
  add_box(walls, 8.2, 4.3, 9.4, 6.9);      // robot cell
  add_box(walls, 12.4, 2.0, 13.2, 2.8);    // column
  add_box(walls, 15.6, 5.8, 18.2, 7.0);    // machine
  add_box(walls, 1.0, 6.2, 1.9, 7.6);      // cupboard
  add_wall(walls, 11.0, 10.0, 11.0, 8.1);  // screen
  add_wall(walls, 20.0, 3.0, 18.6, 3.0);
  return walls;
}
/// A way twice around it.
inline const std::vector<Point2<Map>> kTwoRounds{
    {2.5, 1.2}, {11.0, 1.2}, {14.4, 1.0}, {14.4, 4.2}, {14.4, 8.2}, {12.5, 8.2}, {11.0, 7.2},
    {7.0, 7.8}, {6.5, 3.8},  {6.5, 1.2},  {2.5, 1.2},  {11.0, 1.2}, {14.4, 1.0}, {14.4, 4.2}};

/// A factory floor of 80 m x 50 m: outer wall with bays, columns, office block, machine rows, storage.
inline mapping::Walls factory_floor() {
  mapping::Walls walls;
  add_wall(walls, 0.0, 0.0, 52.0, 0.0);
  add_wall(walls, 52.0, 0.0, 52.0, 3.0);
  add_wall(walls, 52.0, 3.0, 80.0, 3.0);
  add_wall(walls, 80.0, 3.0, 80.0, 50.0);
  add_wall(walls, 80.0, 50.0, 24.0, 50.0);
  add_wall(walls, 24.0, 50.0, 24.0, 46.5);
  add_wall(walls, 24.0, 46.5, 0.0, 46.5);
  add_wall(walls, 0.0, 46.5, 0.0, 0.0);
  for (int i = 1; i <= 7; ++i)
    for (int j = 1; j <= 3; ++j)  // columns on the 10 m x 12 m grid of the building
      add_box(walls, 10.0 * i - 0.25, 12.0 * j - 0.25, 10.0 * i + 0.25, 12.0 * j + 0.25);
  add_box(walls, 62.0, 38.0, 79.6, 49.6);  // offices
  add_wall(walls, 62.0, 38.0, 62.0, 30.0);
  add_box(walls, 3.0, 27.0, 15.0, 33.0);  // store
  add_wall(walls, 0.0, 20.0, 6.0, 20.0);
  add_box(walls, 22.0, 5.0, 35.0, 8.0);  // machine rows
  add_box(walls, 22.0, 14.5, 35.0, 17.0);
  add_box(walls, 42.5, 14.0, 47.0, 33.5);
  add_box(walls, 54.0, 8.0, 57.0, 20.0);
  add_box(walls, 66.0, 10.0, 76.0, 12.5);
  add_wall(walls, 30.0, 50.0, 30.0, 39.0);
  add_wall(walls, 30.0, 39.0, 36.0, 39.0);
  return walls;
}

/// A random pose inside the bounds of `field` at least `clearance_m` from every wall and, as a ray in each of
/// 16 directions meets a wall, not outside the building nor inside a closed box smaller than `least_view_m`.
template <class Engine>
Transform2<Map, Base> random_pose(const mapping::Walls& walls, const mapping::DistanceField& field,
                                  double clearance_m, double least_view_m, Engine& engine) {
  const mapping::GridFrame& frame = field.frame();
  std::uniform_real_distribution<double> x(frame.origin.x_m, frame.origin.x_m + frame.width * frame.cell_m);
  std::uniform_real_distribution<double> y(frame.origin.y_m, frame.origin.y_m + frame.height * frame.cell_m);
  std::uniform_real_distribution<double> yaw(-kPi, kPi);
  for (;;) {
    const Point2<Map> p{x(engine), y(engine)};
    if (field.distance_m(p) < clearance_m) continue;
    double farthest = 0.0;
    for (int i = 0; i < 16; ++i) farthest = std::max(farthest, cast_ray(walls, p, 0.01 + i * kPi / 8.0));
    if (std::isfinite(farthest) && farthest >= least_view_m) return {p.x_m, p.y_m, yaw(engine)};
  }
}

}  // namespace madori::test
