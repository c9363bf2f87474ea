#pragma once

#include <array>
#include <deque>
#include <span>
#include <vector>

#include "core/stamp.hpp"
#include "mapping/site/site.hpp"
#include "simulation/lidar/beam_spot.hpp"
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

/// How a sensor leans against its vehicle, degrees: nose down, and left side up.
struct Lean {
  double pitch_deg = 0.0, roll_deg = 0.0;
};

/// Where a sensor is when the vehicle stands at `pose`: on a ramp it is tilted with the vehicle.
[[nodiscard]] SensorPose sensor_pose(const World& world, const Transform2<Building, Base>& pose,
                                     const mapping::SensorRecord& mounting, const Lean& lean = {});

/// What a sensor can look at.
struct View {
  const World& world;
  const PoseTrack& track;
  const std::vector<Body>& bodies;
};

/// Hits of many beams: the never moving world by Embree, eight rays at a time, then the bodies that stand in
/// the directions of the batch.
class BeamBatch {
 public:
  /// Empties the batch; `count` beams will follow, each of the rays of `spot`.
  void reset(std::size_t count, const BeamSpot& spot = {});
  /// A beam's direction in the sensor's frame, of unit length and not upright.
  void set(std::size_t i, const SensorPose& from, double dx, double dy, double dz);
  void cast(const RayCaster& rays, const std::vector<Body>& bodies, float range_max_m);
  /// Of a beam's middle ray, or of the first of a spot that has none in the middle.
  [[nodiscard]] const Hit& hit(std::size_t i) const { return hits_[i]; }
  /// Of all rays of a beam. Valid until the next call.
  [[nodiscard]] std::span<const Hit> spot(std::size_t i) const;

 private:
  using Vector = std::array<double, 3>;
  void set_ray(std::size_t ray, const Vector& origin, const Vector& direction);  ///< Building frame
  void cast_body(const Body& body, float range_max_m);

  std::size_t beams_ = 0;
  std::size_t count_ = 0;  ///< rays: the first of all beams, then the second of all beams ...
  BeamSpot spot_;
  std::vector<RayPacket> packets_;
  std::vector<Hit> hits_;
  mutable std::vector<Hit> of_spot_;
};

}  // namespace madori::simulation
