#pragma once

#include "localization/drawing_fit/memory_cloud.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

/// Where a place of a drawn room lies between what was seen of the room as it stands (the building's metres,
/// typed Map). In sixteen directions of the drawing it is to be as far from the first surface seen as it is
/// drawn from the first wall, or to divide the room's width as it does on the drawing; a direction in which
/// something else stands says little against (a mixture), one that looks past an edge, drawn or seen,
/// nothing. `expected` is where it would be without that, with a standard deviation of `sigma_m` > 0 an axis.
/// For a person a place of a route is one between walls, whichever of them the warp takes a surface for.
[[nodiscard]] Point2<Map> place_by_clearances(const mapping::Walls& drawn, const MemoryCloud& seen,
                                              const Point2<Map>& place, const Point2<Map>& expected,
                                              double sigma_m);

}  // namespace madori::localization
