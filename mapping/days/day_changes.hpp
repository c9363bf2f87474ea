#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mapping/days/day_clusters.hpp"
#include "mapping/days/day_map.hpp"

namespace madori::mapping {

enum class ChangeKind { Gone, New, Moved };

/// What changed in the building between two days.
struct DayChange {
  ChangeKind kind = ChangeKind::Gone;
  Point2<Map> centre;               ///< where it is now; of what is gone, where it was
  double width_m = 0.0;             ///< of its box there, along x
  double height_m = 0.0;            ///< along y
  std::size_t cells = 0;            ///< that it covers there
  std::optional<Point2<Map>> from;  ///< of what moved: where it was
  CivilDay before{};                ///< the last look at it as it was
  CivilDay since{};                 ///< the first day that shows it as it is now
};

/// What is taken for the same thing in another place.
struct MovedOptions {
  double farthest_m = 3.0;   ///< between the centres
  double cells_ratio = 0.5;  ///< of the smaller to the larger: another side of it is seen from another place
  double extent_m =
      0.5;  ///< two cells: by which the longer and the shorter sides of the boxes may differ ...
  double extent_share = 0.3;  ///< ... or this share of the longer box's, where that is more
};

/// What the last of these days shows otherwise than the first; the days between tell when. Largest first.
/// Nothing for fewer than two days. Precondition: oldest first, all of one frame and cell_m.
[[nodiscard]] std::vector<DayChange> changes_between(std::span<const DayMap> days,
                                                     const MovedOptions& options = {});

}  // namespace madori::mapping
