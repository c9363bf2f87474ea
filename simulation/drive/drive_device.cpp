#include "simulation/drive/drive_device.hpp"

#include <array>
#include <cmath>

#include "core/angle.hpp"

namespace madori::simulation {
namespace {

namespace wire = control::wire;

std::uint32_t microseconds(Duration now) {
  return static_cast<std::uint32_t>(now.count() / 1000);
}

}  // namespace

std::uint16_t encoder_counts(double angle_rad) {
  const double turns = angle_rad / (2.0 * kPi);
  const auto counts = static_cast<std::int32_t>((turns - std::floor(turns)) * wire::kCountsPerTurn);
  return static_cast<std::uint16_t>(counts % wire::kCountsPerTurn);
}

void DriveDevice::receive(std::span<const std::uint8_t> bytes, Duration now) {
  for (const std::uint8_t byte : bytes) controller_.receive(byte, microseconds(now));
}

void DriveDevice::tick(const VehicleState& vehicle, bool bumper, const DriveTrouble& trouble, Duration now) {
  inputs_.bumper = bumper;
  inputs_.emergency_stop = trouble.emergency_stop;
  inputs_.faults = trouble.fault ? wire::kOvertemperature : wire::kNoFault;
  inputs_.battery_mv = battery_mv_;
  if (!trouble.left_encoder_stuck) inputs_.left_angle = encoder_counts(vehicle.left_rad);
  if (!trouble.right_encoder_stuck) inputs_.right_angle = encoder_counts(vehicle.right_rad);
  controller_.tick(inputs_, microseconds(now));
}

control::WheelSpeeds DriveDevice::asked() const {
  return {controller_.left_uradps() * 1e-6, controller_.right_uradps() * 1e-6};
}

std::vector<std::uint8_t> DriveDevice::status_frame() {
  std::array<std::uint8_t, wire::kMaxFrame> frame{};
  const std::size_t size = controller_.status_frame(frame.data());
  return {frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size)};
}

}  // namespace madori::simulation
