#pragma once

#include <vector>

#include "localization/mounting/room_walls.hpp"

namespace madori::localization {

/// Where a lidar sits on the vehicle, from its own motion and the vehicle's, both from the first sweep to
/// each: the closed form of hand-eye calibration in the plane (Censi et al. 2013, Eq. 23 f.), linear in the
/// place and in the sine and cosine of the yaw. Rotations are the lidar's, ways the wheels'. What the motions
/// do not tell is taken from `believed`.
[[nodiscard]] Transform2<Base, Lidar> closed_form_mounting(const std::vector<Transform2<Room, Lidar>>& lidar,
                                                           const std::vector<Transform2<Odom, Base>>& vehicle,
                                                           const LidarMounting& believed);

}  // namespace madori::localization
