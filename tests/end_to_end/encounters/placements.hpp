#pragma once

#include <optional>
#include <random>

#include "tests/support/lock_step_run.hpp"

namespace madori::encounters {

/// The plan of one encounter.
struct Placement {
  simulation::MoverSpec mover;
  Point2<Map> at;  ///< on the way, where they are to meet
};

/// Looks for places on the way ahead of a driving vehicle. Nothing where the way ends, a door is near, or
/// there is no room: the caller tries again a step later.
class Placements {
 public:
  Placements(const test::LockStepRun& run, std::mt19937& random, double speed_mps)
      : run_(run), random_(random), speed_mps_(speed_mps) {}

  /// A body on the way, a little aside of it, beyond the lidar's blind zone.
  [[nodiscard]] std::optional<Placement> standing(simulation::MoverKind kind);
  /// A person who comes at the way from one side, about when the vehicle does, and gives way to nobody.
  [[nodiscard]] std::optional<Placement> crossing();

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  [[nodiscard]] bool is_free(const Point2<Map>& at, double radius_m) const;
  [[nodiscard]] Point2<simulation::Plan> on_plan(const Point2<Map>& at) const {
    return run_.factory->world().frames().map_from_plan.inverse() * at;
  }
  /// A point of the way `ahead_m` further, with its heading.
  [[nodiscard]] std::optional<PathPoint> way_point(double ahead_m) const;

  const test::LockStepRun& run_;
  std::mt19937& random_;
  double speed_mps_;
};

}  // namespace madori::encounters
