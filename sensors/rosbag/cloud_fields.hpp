#pragma once

#include "core/frames.hpp"
#include "core/point_cloud.hpp"
#include "core/result.hpp"
#include "sensors/rosbag/bridge.hpp"

namespace madori::sensors {

/// sensor_msgs/PointCloud2 to points: x, y, z (float32 or float64, metres) are needed; intensity, ring and
/// time/t/time_offset (seconds, float; nanoseconds, integer) are taken where they are; negative ones are of a
/// message that is stamped at its end (velodyne_pointcloud's default), whose stamp is moved to the first
/// firing. Points that are not finite are left out. Fails when fields or rows lie outside the data, or on
/// more than 4,000,000 points.
[[nodiscard]] Result<PointCloud<Lidar>> cloud_from_fields(const rosbag_bridge::Cloud& cloud);

/// x, y, z, intensity, time: float32; ring: uint16. Little-endian, one row.
[[nodiscard]] rosbag_bridge::Cloud fields_from_cloud(const PointCloud<Lidar>& cloud);

}  // namespace madori::sensors
