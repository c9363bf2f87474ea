#pragma once

#include <vector>

#include "localization/drawing_fit/memory_cloud.hpp"
#include "localization/drawing_fit/wall_index.hpp"
#include "localization/warp/drawing_warp.hpp"

namespace madori::localization {

/// Warps in which a part of what is remembered lies elsewhere on the drawing than `warp` has it, where drawn
/// walls run as those that are seen do: walls taken for their neighbours. Where a fit may begin, too. The
/// likeliest few for the surroundings of `at` (Building), by these alone; and of all rooms of the memory the
/// few that fit best elsewhere, where one fits better than where it is. None of a warp without a field.
[[nodiscard]] std::vector<DrawingWarp> other_ways(const WallIndex& drawn, const MemoryCloud& cloud,
                                                  const DrawingWarp& warp, const Point2<Building>& at);

}  // namespace madori::localization
