#pragma once

#include <cstddef>
#include <vector>

#include "core/path.hpp"
#include "core/result.hpp"
#include "planning/obstacle_check/path_check.hpp"

namespace madori::planning {

struct SideDetourOptions {
  double first_offset_m = 0.3;
  double offset_step_m = 0.2;
  double furthest_m = 2.0;       ///< the route is left by at most this much
  double min_run_m = 1.2;        ///< shortest way over which the full offset is gained or given back
  double run_per_offset = 2.2;   ///< metres of way for a metre of offset; smaller turns sharper
  double min_radius_m = 0.3;     ///< sharper bends are not followed
  double speed_mps = 0.5;        ///< on the detour
  double before_rejoin_m = 0.6;  ///< after the last blocked waypoint, beyond the vehicle's length
};

/// A path that leaves `path` at point `from`, passes what blocks it on one side, and comes back to it; `path`
/// from `rejoin` on is its end.
struct Detour {
  Path path;               ///< whole: the way around and the rest of the route
  std::size_t rejoin = 0;  ///< first point of `path` that lies on the route again
  double offset_m = 0.0;   ///< positive left
};

/// Tries candidates left and right of the route at growing offset (layout-map paper, section 3.4), each
/// checked as the route itself is, and takes the first that is free and can be followed. Fails where both
/// sides are blocked at every offset, or where the route turns on the spot within the blocked stretch.
/// `obstacles` and `walls` as in check_path().
[[nodiscard]] Result<Detour> side_detour(const Path& path, std::size_t from, const PathCheck& check,
                                         const std::vector<Point2<Map>>& obstacles, const WallGrid& walls,
                                         const CheckOptions& options, const SideDetourOptions& detour = {});

/// Headings and curvatures of a path from its positions (both ends keep their heading).
void renew_headings(Path& path, std::size_t first, std::size_t last);

}  // namespace madori::planning
