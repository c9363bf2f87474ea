#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "control/diff_drive/kinematics.hpp"
#include "control/drive_link/command_lag.hpp"
#include "control/drive_link/wire.hpp"
#include "core/stamp.hpp"
#include "io/stream_link.hpp"

namespace madori::control {

struct DriveLinkOptions {
  std::string device;  ///< /dev/ttyUSB0, or a pseudo-terminal
  unsigned baud = 115'200;
};

struct DriveLinkCounters {
  std::uint64_t status_frames = 0, damaged = 0, lost = 0, commands = 0, refused_commands = 0, openings = 0;
};

/// The PC's end of the drive link. It sends only when send() is called, once in every cycle of the control
/// loop: a hung loop must fall silent, so that the controller's watchdog stops the wheels.
class DriveLink {
 public:
  using StatusSink = std::function<void(const wire::Status&, Duration behind)>;
  /// `sink` is called from the link's thread for every good status frame, with how far the drive is behind
  /// what it was told (CommandLag).
  explicit DriveLink(const DriveLinkOptions& options, StatusSink sink = {});

  /// Wheel speeds for this cycle. False when the command did not go out: link closed, numbers that are not
  /// finite or beyond what the protocol carries (then nothing is sent at all, and the watchdog does its
  /// work).
  bool send(const WheelSpeeds& speeds, bool enable);

  [[nodiscard]] DriveLinkCounters counters() const;
  [[nodiscard]] bool is_open() const { return link_->is_open(); }
  /// Why the link is closed, in words; empty while it is open.
  [[nodiscard]] std::string problem() const;

 private:
  void receive(std::span<const std::uint8_t> bytes);

  DriveLinkOptions options_;
  StatusSink sink_;
  wire::FrameCutter cutter_;
  mutable std::mutex mutex_;
  CommandLag lag_;
  std::uint16_t last_status_ = 0;
  DriveLinkCounters counters_;
  std::string problem_ = "not opened yet";
  std::uint16_t sequence_ = 0;
  std::unique_ptr<io::StreamLink> link_;  ///< last: its thread uses all of the above
};

}  // namespace madori::control
