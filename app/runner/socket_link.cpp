#include "app/runner/socket_link.hpp"

#include <utility>

namespace madori::app {
namespace {

constexpr std::size_t kMostStatuses = 200;  ///< a hung cycle must not fill the memory
constexpr std::size_t kMostClouds = 3;
constexpr std::size_t kMostPackets = 2000;

}  // namespace

SocketLink::SocketLink(const SocketOptions& options, const WheelGeometry& wheels) : wheels_(wheels) {
  if (!options.safety_scanner.empty())
    scanner_ = std::make_unique<sensors::s300::Receiver>(
        sensors::s300::ReceiverOptions{.device = options.safety_scanner});
  drive_ =
      std::make_unique<control::DriveLink>(control::DriveLinkOptions{.device = options.drive_device},
                                           [this](const control::wire::Status& status, Stamp /*received*/) {
                                             const std::scoped_lock lock(mutex_);
                                             if (statuses_.size() >= kMostStatuses)
                                               statuses_.erase(statuses_.begin());
                                             statuses_.push_back(status);
                                           });
  lidar_ = std::make_unique<sensors::vlp16::Receiver>(
      sensors::vlp16::ReceiverOptions{options.lidar_address, options.lidar_port, options.lidar_position_port},
      [this](sensors::vlp16::Frame& frame) {
        const std::scoped_lock lock(mutex_);
        if (clouds_.size() >= kMostClouds) {
          clouds_.erase(clouds_.begin());
          firings_us_.erase(firings_us_.begin());
        }
        clouds_.push_back(std::move(frame.cloud));
        firings_us_.push_back(frame.first_firing_us);
      },
      [this](std::span<const std::uint8_t> bytes, Stamp received) {
        const std::scoped_lock lock(mutex_);
        if (packets_.size() < kMostPackets) packets_.push_back({received, {bytes.begin(), bytes.end()}});
      });
}

void SocketLink::collect(CycleInput& input) {
  const std::scoped_lock lock(mutex_);
  input.drive = std::exchange(statuses_, {});
  input.clouds = std::exchange(clouds_, {});
  input.firings_us = std::exchange(firings_us_, {});
  input.packets = std::exchange(packets_, {});
  input.protective_stop = scanner_ && scanner_->must_stop();
}

void SocketLink::send(const CycleOutput& output) {
  drive_->send(control::wheel_speeds(wheels_, output.command), output.enable);
}

std::string SocketLink::problem() const {
  if (const auto drive = drive_->problem(); !drive.empty()) return "drive: " + drive;
  if (const auto foreign = lidar_->foreign_sensor(); !foreign.empty())
    return "lidar: a " + foreign + " sends here, not a VLP-16";
  if (const auto other = lidar_->stranger(); !other.empty())
    return "lidar: " + other + " sends to its port too and is ignored: switch that one off";
  if (lidar_->silence() > std::chrono::seconds(1))
    return "lidar: no packets on UDP " + std::to_string(lidar_->data_port());
  if (scanner_)
    if (const auto reason = scanner_->stop_reason(); !reason.empty()) return "safety scanner: " + reason;
  return "";
}

}  // namespace madori::app
