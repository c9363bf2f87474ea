#pragma once

#include <vector>

#include "localization/drawing_fit/memory_cloud.hpp"
#include "localization/drawing_fit/wall_index.hpp"
#include "localization/warp/drawing_warp.hpp"

namespace madori::localization {

/// Warps in which the surroundings of `at` (Building) lie elsewhere on the drawing than `warp` has them,
/// where drawn walls run as those that are seen do: walls taken for their neighbours. Where a fit may begin,
/// too; the likeliest few, by the surroundings alone. None of a warp without a field.
[[nodiscard]] std::vector<DrawingWarp> other_ways(const WallIndex& drawn, const MemoryCloud& cloud,
                                                  const DrawingWarp& warp, const Point2<Building>& at);

}  // namespace madori::localization
