#pragma once

#include <vector>

#include "localization/drawing_fit/memory_cloud.hpp"
#include "localization/drawing_fit/wall_index.hpp"

namespace madori::localization {

/// The likeliest ways in which a cloud may lie on the whole drawing, by the tables of distances alone: all
/// places on a grid and all turns; at most `wanted`, likeliest first, no two that bring the vehicle, at
/// `at` in the cloud, to the same place. Takes tenths of a second on a large site.
[[nodiscard]] std::vector<Transform2<Map, Map>> survey(const WallIndex& index, const MemoryCloud& cloud,
                                                       const Transform2<Map, Base>& at, std::size_t wanted);

/// The cloud as a mirror shows it (x changes its sign).
[[nodiscard]] MemoryCloud mirror_image(const MemoryCloud& cloud);

}  // namespace madori::localization
