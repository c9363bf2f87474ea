#pragma once

#include <random>

#include "localization/drawing_fit/memory_cloud.hpp"
#include "localization/drawing_fit/wall_index.hpp"
#include "localization/pose_axes.hpp"
#include "tests/support/made_up_buildings.hpp"

namespace madori::test {

/// A site of `tiles` x `tiles` factory floors, 80 m x 50 m each, no two alike: each wall stands up to 3 m
/// from where the floor has it. One tile: the floor itself.
inline mapping::Walls tiled_floor(int tiles, std::mt19937& engine) {
  std::uniform_real_distribution<double> shift(-3.0, 3.0);
  mapping::Walls walls;
  for (int column = 0; column < tiles; ++column)
    for (int row = 0; row < tiles; ++row)
      for (const mapping::Wall& wall : factory_floor()) {
        const double x_m = 80.0 * column + (tiles > 1 ? shift(engine) : 0.0);
        const double y_m = 50.0 * row + (tiles > 1 ? shift(engine) : 0.0);
        const Segment2<Map>& s = wall.segment;
        add_wall(walls, s.a.x_m + x_m, s.a.y_m + y_m, s.b.x_m + x_m, s.b.y_m + y_m);
      }
  return walls;
}

/// Seven tenths of the walls within `range_m` as a vehicle sees them, a piece every 0.2 m that looks at it;
/// each wall stands sigma_m (one sigma) beside where it is drawn. Nothing hides anything.
inline localization::MemoryCloud seen_from(const Point2<Map>& here, const mapping::Walls& walls,
                                           double range_m, double sigma_m, std::mt19937& engine) {
  std::normal_distribution<double> beside(0.0, 1.0);
  std::bernoulli_distribution seen(0.7);
  localization::MemoryCloud cloud;
  for (const mapping::Wall& wall : walls) {
    const Segment2<Map>& s = wall.segment;
    const double length_m = s.length_m(), off_m = sigma_m * beside(engine);
    const double along_x = (s.b.x_m - s.a.x_m) / length_m, along_y = (s.b.y_m - s.a.y_m) / length_m;
    const double left = along_x * (here.y_m - s.a.y_m) - along_y * (here.x_m - s.a.x_m);
    const double nx = left < 0.0 ? along_y : -along_y, ny = left < 0.0 ? -along_x : along_x;
    for (double m = 0.1; m < length_m; m += localization::kVoxelM) {
      const Point2<Map> at{s.a.x_m + m * along_x + off_m * nx, s.a.y_m + m * along_y + off_m * ny};
      if (distance_m(at, here) > range_m || !seen(engine)) continue;
      cloud.push_back(
          {at.x_m, at.y_m, nx, ny, 0, localization::WallIndex::direction_of(nx, ny), 1, 1.0, 1.0});
    }
  }
  return cloud;
}

/// A random place of the site, and what was remembered around it by a memory that began anywhere.
class SurveyedPlaces {
 public:
  struct Trial {
    Transform2<Map, Base> place, at;
    localization::MemoryCloud cloud;

    [[nodiscard]] bool is_there(const Transform2<Map, Map>& correction) const {
      return localization::same_place(correction * at, place, 0.9, to_rad(8.0));
    }
  };
  SurveyedPlaces(const mapping::Walls& walls, int tiles, double range_m, double sigma_m)
      : walls_(walls),
        range_m_(range_m),
        sigma_m_(sigma_m),
        x_(3.0, 80.0 * tiles - 3.0),
        y_(5.0, 50.0 * tiles - 5.0) {}

  [[nodiscard]] Trial next(std::mt19937& engine) {
    const double x_m = x_(engine), y_m = y_(engine), yaw_rad = turn_(engine);
    const Transform2<Map, Base> place(x_m, y_m, yaw_rad);
    const auto seen = seen_from(place.translation(), walls_, range_m_, sigma_m_, engine);
    const double dx_m = shift_(engine), dy_m = shift_(engine), turn_rad = turn_(engine);
    const Transform2<Map, Map> elsewhere(dx_m, dy_m, turn_rad);
    return {place, elsewhere * place, moved(seen, elsewhere)};
  }

 private:
  const mapping::Walls& walls_;
  double range_m_, sigma_m_;
  std::uniform_real_distribution<double> x_, y_, turn_{-kPi, kPi}, shift_{-60.0, 60.0};
};

}  // namespace madori::test
