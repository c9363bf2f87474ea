#pragma once

#include <cstdint>
#include <vector>

#include "core/pose_estimate.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::app {

/// A picture (PNG bytes) of the drawing in grey and the way on it, by the health at each pose: LOCALIZED a
/// solid line, DEGRADED dashed, AMBIGUOUS dots, LOST crosses; the uncertainty (2 sigma) every few metres,
/// start and end, and a strip with the health over time. About `longest_px` on the longer side.
[[nodiscard]] std::vector<std::uint8_t> trajectory_plot(const mapping::Walls& walls,
                                                        const std::vector<PoseEstimate>& estimates,
                                                        int longest_px = 1400);

}  // namespace madori::app
