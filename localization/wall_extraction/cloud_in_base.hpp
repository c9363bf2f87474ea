#pragma once

#include "core/point_cloud.hpp"
#include "core/transform2.hpp"
#include "localization/motion_model/odometry_track.hpp"

namespace madori::localization {

/// A revolution in the Base frame of its last firing: each point is moved by what the wheels did since its
/// own. The result's stamp is the last firing's, its time offsets are zero. `height_m` is the lidar's above
/// the floor. Where the track knows nothing, the vehicle counts as standing.
[[nodiscard]] PointCloud<Base> cloud_in_base(const PointCloud<Lidar>& cloud,
                                             const Transform2<Base, Lidar>& base_from_lidar, double height_m,
                                             const OdometryTrack& track);

}  // namespace madori::localization
