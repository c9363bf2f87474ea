#pragma once

#include <deque>
#include <optional>

#include "core/frames.hpp"
#include "core/odometry.hpp"
#include "core/point_cloud.hpp"

namespace madori::sensors {

/// The latest dead reckoning, to be asked for poses in between.
class OdometryTrack {
 public:
  /// Readings that are not newer than the last are ignored. Keeps `length` of the past.
  explicit OdometryTrack(Duration length = std::chrono::seconds(10)) : length_(length) {}
  void add(const OdometryReading& reading);
  void clear() { readings_.clear(); }

  /// Between two readings position and heading go evenly; nothing outside the track.
  [[nodiscard]] std::optional<Transform2<Odom, Base>> at(Stamp stamp) const;
  [[nodiscard]] bool covers(Stamp from, Stamp to) const;

 private:
  Duration length_;
  std::deque<OdometryReading> readings_;
};

/// Moves every point to where it would have been seen at the cloud's stamp (motion compensation). The time
/// offsets stay. False, and the cloud untouched, when the track does not cover the sweep.
bool deskew(PointCloud<Lidar>& cloud, const Transform2<Base, Lidar>& base_from_lidar,
            const OdometryTrack& track);

}  // namespace madori::sensors
