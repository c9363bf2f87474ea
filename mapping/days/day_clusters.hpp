#pragma once

#include <vector>

#include "mapping/days/day_map.hpp"

namespace madori::mapping {

struct DayPlace {
  int column = 0;
  int row = 0;
  friend auto operator<=>(const DayPlace&, const DayPlace&) = default;
};

/// Cells that changed together.
struct DayCluster {
  std::vector<DayPlace> cells;
  Point2<Map> centre;     ///< the mean of the cells' middles
  double width_m = 0.0;   ///< of their box, along x
  double height_m = 0.0;  ///< along y
};

/// Fewer cells that changed for sure are noise: up to 4 were seen where nothing had changed
/// (docs/explanation/living-map.md). A person or a post covers up to two by two cells of 0.25 m.
inline constexpr std::size_t kLeastCells = 5;

/// Where something stood in `before` and floor is free in `now`, in clusters of at least kLeastCells. What is
/// unseen or moving then or now says nothing. Only cells around which all was seen now, and nothing stands,
/// make a cluster: where something stands in the next cell it may be the same surface (ranges and pose are
/// good to half a cell), and where that is unseen, beams only grazed a surface, for they would have passed
/// through a place that is empty. Other cells are added to a cluster that they touch. Swapped arguments give
/// what is new. Precondition: the same frame and cell_m.
[[nodiscard]] std::vector<DayCluster> vanished(const DayMap& before, const DayMap& now);

}  // namespace madori::mapping
