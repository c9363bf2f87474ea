#pragma once

#include <array>
#include <deque>
#include <vector>

#include "core/stamp.hpp"
#include "mapping/site/site.hpp"
#include "simulation/world/body.hpp"
#include "simulation/world/world.hpp"

namespace madori::simulation {

/// A sensor's place in the building: columns of the rotation are its axes, Building frame.
struct SensorPose {
  std::array<double, 3> origin_m{};
  std::array<double, 9> rotation{};  ///< row-major building_from_sensor
};

/// The vehicle's way over the last fraction of a second, to be asked for poses in between: a lidar's beams
/// leave from where the vehicle is at their own time. Times are nanoseconds since the start.
class PoseTrack {
 public:
  void add(Duration time, const Transform2<Building, Base>& pose);
  /// Forgets the past, so that a jump (kidnapping) is not driven.
  void clear() { poses_.clear(); }
  [[nodiscard]] Transform2<Building, Base> at(Duration time) const;

 private:
  struct Entry {
    Duration time{};
    Transform2<Building, Base> pose;
  };
  std::deque<Entry> poses_;
};

/// Where a sensor is when the vehicle stands at `pose`: on a ramp it is tilted with the vehicle.
[[nodiscard]] SensorPose sensor_pose(const World& world, const Transform2<Building, Base>& pose,
                                     const mapping::SensorRecord& mounting);

/// What a sensor can look at.
struct View {
  const World& world;
  const PoseTrack& track;
  const std::vector<Body>& bodies;
};

/// Hits of many rays: the never moving world by Embree, eight at a time, then the bodies that stand in the
/// directions of the batch.
class BeamBatch {
 public:
  /// Empties the batch; `count` rays will follow.
  void reset(std::size_t count);
  void set(std::size_t i, const SensorPose& from, double dx, double dy, double dz) {
    RayPacket& p = packets_[i / RayPacket::kLanes];
    const std::size_t lane = i % RayPacket::kLanes;
    const auto& r = from.rotation;
    p.x_m[lane] = static_cast<float>(from.origin_m[0]);
    p.y_m[lane] = static_cast<float>(from.origin_m[1]);
    p.z_m[lane] = static_cast<float>(from.origin_m[2]);
    p.dx[lane] = static_cast<float>(r[0] * dx + r[1] * dy + r[2] * dz);
    p.dy[lane] = static_cast<float>(r[3] * dx + r[4] * dy + r[5] * dz);
    p.dz[lane] = static_cast<float>(r[6] * dx + r[7] * dy + r[8] * dz);
  }
  void cast(const RayCaster& rays, const std::vector<Body>& bodies, float range_max_m);
  [[nodiscard]] const Hit& hit(std::size_t i) const { return hits_[i]; }

 private:
  void cast_body(const Body& body, float range_max_m);

  std::size_t count_ = 0;
  std::vector<RayPacket> packets_;
  std::vector<Hit> hits_;
};

}  // namespace madori::simulation
