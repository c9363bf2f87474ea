#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "control/diff_drive/kinematics.hpp"
#include "control/drive_link/controller.hpp"
#include "core/stamp.hpp"
#include "simulation/scenario/scenario.hpp"
#include "simulation/vehicle/vehicle.hpp"

namespace madori::simulation {

/// What is wrong with the drive at the moment.
struct DriveTrouble {
  bool left_encoder_stuck = false, right_encoder_stuck = false;
  bool emergency_stop = false;
  bool fault = false;
};

/// The motor controller: the same state machine as the firmware's, 14-bit encoders on the wheels, a status
/// frame every 10 ms.
class DriveDevice {
 public:
  explicit DriveDevice(const VehicleSpec& spec) : battery_mv_(static_cast<std::uint16_t>(spec.battery_mv)) {}

  /// Bytes from the PC.
  void receive(std::span<const std::uint8_t> bytes, Duration now);
  /// One millisecond: senses, watches, decides.
  void tick(const VehicleState& vehicle, bool bumper, const DriveTrouble& trouble, Duration now);
  /// What the wheels shall do; zero unless the controller is running.
  [[nodiscard]] control::WheelSpeeds asked() const;
  [[nodiscard]] control::wire::DriveState state() const { return controller_.state(); }
  [[nodiscard]] std::vector<std::uint8_t> status_frame();

 private:
  control::wire::Controller controller_;
  control::wire::ControllerInputs inputs_;
  std::uint16_t battery_mv_;
};

/// The AS5048A's reading of a wheel angle.
[[nodiscard]] std::uint16_t encoder_counts(double angle_rad);

}  // namespace madori::simulation
