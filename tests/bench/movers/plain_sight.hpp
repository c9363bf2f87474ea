#pragma once

#include <vector>

#include "core/lidar_model.hpp"
#include "simulation/world/body.hpp"
#include "simulation/world/ray_caster.hpp"

namespace madori::bench {

/// A lidar that stands somewhere in the virtual factory, its floor level.
struct LidarPlace {
  const LidarModel& model;
  Transform2<simulation::Building, Lidar> pose;
};

/// Beams of one sweep.
struct BeamsOn {
  double met = 0.0;    ///< that meet the body before anything else
  double would = 0.0;  ///< ... and would if nothing stood before it
};

/// The beams of a sweep towards a body, counted by at most 24 directions of it; glass does not hide.
[[nodiscard]] BeamsOn beams_on(const simulation::Body& body, const std::vector<simulation::Body>& all,
                               const simulation::RayCaster& building, const LidarPlace& lidar);

/// Three beams or more, and half of those that would meet it, reach the body: what a person who looks at the
/// scan could point at.
[[nodiscard]] bool is_in_plain_sight(const BeamsOn& beams);

}  // namespace madori::bench
