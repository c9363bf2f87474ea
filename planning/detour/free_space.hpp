#pragma once

#include <cstdint>
#include <vector>

#include "core/path.hpp"
#include "core/result.hpp"
#include "planning/obstacle_check/path_check.hpp"

namespace madori::planning {

struct FreeSpaceOptions {
  double turning_radius_m = 0.45;
  double room_m = 3.0;  ///< searched around the box of start and goal: as far as the scan shows well
  double spacing_m = 0.1;
  double speed_mps = 0.4;
  double longest_m = 8.0;  ///< longer ways, with the share below of the direct distance added, are refused
  double longest_share = 1.5;
  std::uint64_t max_checks = 60'000;  ///< placements: about 0.1 s. No time, so that the same is found again
  std::uint32_t seed = 1;             ///< at least 1
};

/// A path from `start` to `goal` through what is free by the scan and the drawing: OMPL's RRT-Connect over
/// Dubins curves (the vehicle drives forward only). Exact solutions alone count, made shorter where a direct
/// curve is free. Fails with a reason where none is found in time, or only a long one. One call at a time:
/// OMPL's seed is global.
[[nodiscard]] Result<Path> free_space_path(const Transform2<Map, Base>& start,
                                           const Transform2<Map, Base>& goal,
                                           const std::vector<Point2<Map>>& obstacles, const WallGrid& walls,
                                           const CheckOptions& check, const FreeSpaceOptions& options = {});

}  // namespace madori::planning
