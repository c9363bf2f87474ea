#include "tests/end_to_end/encounters/placements.hpp"

#include <algorithm>
#include <cmath>

#include "app/cycle/stages.hpp"

namespace madori::encounters {

using simulation::MoverKind;

bool Placements::is_free(const Point2<Map>& at, double radius_m) const {
  const auto& world = run_.factory->world();
  const auto centre = world.frames().building_pose({at.x_m, at.y_m, 0.0}).translation();
  return world.obstacles().find(simulation::rectangle(centre, 0.0, 2.0 * radius_m, 2.0 * radius_m),
                                {0.05, 1.7}) == nullptr;
}

std::optional<PathPoint> Placements::way_point(double ahead_m) const {
  const auto& state = run_.state();
  const double along_m = state.progress.along_m + ahead_m;
  if (along_m > state.way.path.length_m()) return std::nullopt;
  std::size_t i = state.progress.pursuit.index;
  while (i + 1 < state.way.path.points().size() && state.way.path.along_m(i) < along_m) ++i;
  if (app::is_at_door(run_.run->state(), state.way.path.points()[i].position, run_.run->config()))
    return std::nullopt;
  return state.way.path.points()[i];
}

std::optional<Placement> Placements::standing(MoverKind kind) {
  constexpr double kInView_m = 4.6;
  const auto point = way_point(uniform(4.0, 9.0));
  if (!point) return std::nullopt;
  const double aside_m = uniform(-0.3, 0.3);
  const double across = point->heading_rad + kPi / 2.0;
  const Point2<Map> at{point->position.x_m + aside_m * std::cos(across),
                       point->position.y_m + aside_m * std::sin(across)};
  const double half_m = kind == MoverKind::Cart ? 0.65 : 0.35;
  const Point2<Map> beside{at.x_m + 0.1 * std::cos(across), at.y_m + 0.1 * std::sin(across)};
  const auto here = run_.factory->truth().map_from_base.translation();
  if (distance_m(here, at) < kInView_m || !is_free(at, half_m)) return std::nullopt;
  simulation::MoverSpec mover;
  mover.kind = kind;
  mover.name = kind == MoverKind::Cart ? "cart" : "test body";
  mover.path = {on_plan(at), on_plan(beside)};  // two points give it its direction
  mover.start_s = 1e9;
  return Placement{mover, at};
}

std::optional<Placement> Placements::crossing() {
  constexpr double kFurthest_m = 6.0;
  constexpr double kStep_m = 0.25;
  const double ahead_m = uniform(2.5, 7.0);
  const auto point = way_point(ahead_m);
  if (!point) return std::nullopt;
  simulation::MoverSpec mover;
  mover.name = "person";
  mover.speed_mps = uniform(0.6, 1.6);
  mover.polite_m = 0.0;
  mover.pause_s = 1e9;
  const double side = random_() % 2 == 0 ? 1.0 : -1.0;
  const double direction = point->heading_rad + side * uniform(kPi / 3.0, 2.0 * kPi / 3.0);
  const double wanted_m =
      std::min(kFurthest_m, std::max(1.5, mover.speed_mps * (ahead_m / speed_mps_ + uniform(-1.0, 1.0))));
  const auto along = [&](double way_m) {
    return Point2<Map>{point->position.x_m - way_m * std::cos(direction),
                       point->position.y_m - way_m * std::sin(direction)};
  };
  double before_m = 0.0, after_m = 0.0;
  while (before_m < wanted_m && is_free(along(before_m + kStep_m), 0.25)) before_m += kStep_m;
  while (after_m < 3.0 && is_free(along(-after_m - kStep_m), 0.25)) after_m += kStep_m;
  const auto here = run_.factory->truth().map_from_base.translation();
  if (before_m < 1.5 || after_m < 1.0 || distance_m(here, along(before_m)) < 2.0) return std::nullopt;
  mover.path = {on_plan(along(before_m)), on_plan(along(-after_m))};
  mover.start_s = run_.time_s();
  return Placement{mover, point->position};
}

}  // namespace madori::encounters
