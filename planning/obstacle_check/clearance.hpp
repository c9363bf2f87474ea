#pragma once

#include "core/point2.hpp"
#include "planning/obstacle_check/vehicle_outline.hpp"

namespace madori::planning {

/// Metres from the outline to the point; negative inside: how far it must move to be outside.
[[nodiscard]] double clearance_m(const VehicleOutline& outline, const Point2<Base>& point);
/// ... to the nearest point of the segment, or the one that lies deepest inside.
[[nodiscard]] double clearance_m(const VehicleOutline& outline, const Segment2<Base>& segment);

}  // namespace madori::planning
