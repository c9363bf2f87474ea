#pragma once

#include <vector>

#include "control/diff_drive/kinematics.hpp"
#include "core/wheels.hpp"
#include "mapping/site/site.hpp"
#include "simulation/scenario/scenario.hpp"
#include "simulation/world/mesh.hpp"

namespace madori::simulation {

/// What the wheels and the vehicle do; the wheels' angles are those that the encoders see.
struct VehicleState {
  Transform2<Building, Base> pose;
  double left_rad = 0.0, right_rad = 0.0;        ///< turned since the start
  double left_radps = 0.0, right_radps = 0.0;    ///< now
  double linear_mps = 0.0, angular_radps = 0.0;  ///< of Base over the ground, last step
};

/// Share of each wheel's way that is lost, on top of the scenario's.
struct ExtraSlip {
  double left = 0.0, right = 0.0;
};

/// Two driven wheels and casters: first-order motor lag, limits of acceleration and braking (load makes the
/// first smaller), slip, wheels that are not as large as everybody believes. Positions follow exact arcs.
class Vehicle {
 public:
  Vehicle(const mapping::VehicleRecord& record, const VehicleSpec& spec, std::uint64_t seed);

  /// The state after `dt_s` with the wheels asked to turn at these speeds. `tick` numbers the steps.
  [[nodiscard]] VehicleState advance(const VehicleState& state, const control::WheelSpeeds& asked,
                                     double dt_s, const ExtraSlip& slip, std::uint64_t tick) const;
  /// Floor outline at a pose, counter-clockwise, with a margin on all sides.
  [[nodiscard]] std::vector<Point2<Building>> footprint(const Transform2<Building, Base>& pose,
                                                        double margin_m = 0.0) const;
  /// What can touch something: from the ground clearance to the top of the load.
  [[nodiscard]] HeightRange body() const { return {spec_.ground_clearance_m, record_.height_m}; }
  [[nodiscard]] double dead_time_s() const { return spec_.dead_time_s; }
  [[nodiscard]] const WheelGeometry& true_wheels() const { return wheels_; }
  [[nodiscard]] const mapping::VehicleRecord& record() const { return record_; }

 private:
  [[nodiscard]] double wheel_speed(double now_radps, double asked_radps, double radius_m, double dt_s) const;

  mapping::VehicleRecord record_;
  VehicleSpec spec_;
  WheelGeometry wheels_;
  std::uint64_t seed_;
};

}  // namespace madori::simulation
