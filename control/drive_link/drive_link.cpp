#include "control/drive_link/drive_link.hpp"

#include <cmath>
#include <optional>

#include "core/clock.hpp"

namespace madori::control {
namespace {

/// Micro-radians a second, or nothing when the protocol does not carry it.
std::optional<std::int32_t> to_wire(double speed_radps) {
  const double uradps = speed_radps * 1e6;
  if (!(std::abs(uradps) <= wire::kMaxWheelSpeed)) return std::nullopt;
  return static_cast<std::int32_t>(std::llround(uradps));
}

}  // namespace

DriveLink::DriveLink(const DriveLinkOptions& options, StatusSink sink)
    : options_(options), sink_(std::move(sink)) {
  io::LinkEvents events;
  events.opened = [this] {
    const std::lock_guard lock(mutex_);
    problem_.clear();
    ++counters_.openings;
    cutter_ = {};
  };
  events.bytes = [this](std::span<const std::uint8_t> bytes, Stamp /*received*/) { receive(bytes); };
  events.closed = [this](const std::string& reason) {
    const std::lock_guard lock(mutex_);
    problem_ = options_.device + ": " + reason;
  };
  // A line holds 256 bytes of commands at the most: older ones would be late.
  link_ = io::StreamLink::serial(options.device, options.baud, std::move(events), {.max_pending_bytes = 256});
  link_->start();
}

void DriveLink::receive(std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) {
    if (!cutter_.push(byte)) continue;
    wire::Status status;
    const bool good = wire::decode(cutter_.frame(), cutter_.size(), status) == wire::Verdict::Good;
    Duration behind{};
    {
      const std::lock_guard lock(mutex_);
      if (!good) {
        ++counters_.damaged;
        continue;
      }
      const auto step = static_cast<std::int16_t>(status.sequence - last_status_);
      if (counters_.status_frames > 0 && step > 1) counters_.lost += static_cast<std::uint64_t>(step) - 1U;
      ++counters_.status_frames;
      last_status_ = status.sequence;
      behind = lag_.behind(status.command_sequence, clock_now());
    }
    if (sink_) sink_(status, behind);
  }
}

bool DriveLink::send(const WheelSpeeds& speeds, bool enable) {
  const auto left = to_wire(speeds.left_radps), right = to_wire(speeds.right_radps);
  const std::lock_guard lock(mutex_);
  std::uint8_t frame[wire::kMaxFrame];
  bool sent = false;
  if (left && right) {
    const std::size_t size = wire::encode(wire::Command{++sequence_, enable, *left, *right}, frame);
    lag_.told(sequence_, clock_now());
    sent = link_->write({frame, size});
  }
  ++(sent ? counters_.commands : counters_.refused_commands);
  return sent;
}

DriveLinkCounters DriveLink::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

std::string DriveLink::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

}  // namespace madori::control
