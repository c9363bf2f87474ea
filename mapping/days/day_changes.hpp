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

/// What the last of these days shows otherwise than the first; the days between tell when. Largest first.
/// Nothing for fewer than two days. Precondition: oldest first, all of one frame and cell_m.
[[nodiscard]] std::vector<DayChange> changes_between(std::span<const DayMap> days);

}  // namespace madori::mapping
