#pragma once

#include "core/lidar_model.hpp"
#include "core/point_cloud.hpp"
#include "localization/motion_model/odometry_track.hpp"

namespace madori::localization {

/// A revolution in the Base frame of its last firing: each point is moved by what the wheels did since its
/// own. The result's stamp is the last firing's, its time offsets are zero. Where the track knows nothing,
/// the vehicle counts as standing.
[[nodiscard]] PointCloud<Base> cloud_in_base(const PointCloud<Lidar>& cloud, const LidarModel& lidar,
                                             const OdometryTrack& track);

}  // namespace madori::localization
