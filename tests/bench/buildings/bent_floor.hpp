#pragma once

#include "control/pure_pursuit/pure_pursuit.hpp"
#include "tests/support/bent_building.hpp"
#include "tests/support/virtual_floor.hpp"

namespace madori::bench {

/// Building metres carry the Map type here, as in mapping::Walls and the virtual floor.
using Metric = Map;

/// The scenario of a bent building: its walls, its furniture 0.8 to 2.4 m high, wheels that are not as
/// recorded; a third of the VLP-16's firings.
[[nodiscard]] simulation::Scenario scenario_of(const test::BentBuilding& building);
/// What stands without the furniture.
[[nodiscard]] mapping::Walls walls_of(const test::BentBuilding& building);

/// Drives along the lap, again and again, on the true pose.
class LapDriver {
 public:
  LapDriver(const test::BentBuilding& building, double metres);

  [[nodiscard]] VelocityCommand command(const Transform2<Metric, Base>& truth);
  [[nodiscard]] Transform2<Metric, Base> start() const;
  [[nodiscard]] bool arrived() const { return arrived_; }

 private:
  control::PursuitOptions options_;
  control::TrackedPath path_;
  control::PursuitState pursuit_;
  control::LimitState limits_;
  bool arrived_ = false;
};

}  // namespace madori::bench
