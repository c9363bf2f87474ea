#pragma once

#include <cstdint>
#include <vector>

#include "core/pose_estimate.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::app {

/// A picture (PNG bytes) of the drawing in grey and the way on it: green LOCALIZED, yellow DEGRADED, blue
/// AMBIGUOUS, red LOST; a tick ahead every metre of the way. About `widest_px` on the longer side.
[[nodiscard]] std::vector<std::uint8_t> trajectory_plot(const mapping::Walls& walls,
                                                        const std::vector<PoseEstimate>& estimates,
                                                        int widest_px = 1400);

}  // namespace madori::app
