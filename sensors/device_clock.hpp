#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/stamp.hpp"

namespace madori::sensors {

/// Puts a sensor's own microseconds on the program's clock. A packet can only arrive late, never early: the
/// smallest difference seen is the best, and it may grow by the drift between two quartz clocks. Where every
/// packet of a whole window comes later than that, one of the two clocks was set: the window's best counts.
class DeviceClock {
 public:
  /// A packet whose data was complete at `device_us` (unwrapped) came at `received`.
  void observe(std::int64_t device_us, Stamp received) {
    const Duration offset = received.time_since_epoch() - std::chrono::microseconds(device_us);
    if (offset_) {
      const auto drift = std::chrono::nanoseconds((device_us - last_us_) * kDriftPpm / 1000);
      offset_ = std::min(offset, *offset_ + std::max(drift, Duration(0)));
      take_window(device_us, offset);
    } else {
      offset_ = offset;
      begin_window(device_us, offset);
    }
    last_us_ = device_us;
  }
  void reset() { offset_.reset(); }
  [[nodiscard]] Stamp stamp_of(std::int64_t device_us) const {
    return Stamp(offset_.value_or(Duration(0)) + std::chrono::microseconds(device_us));
  }

 private:
  static constexpr std::int64_t kDriftPpm = 100;
  /// By the device's clock. A backlog that a socket or port keeps while the computer stands still is shorter:
  /// 2 MiB of UDP hold 2.4 s of a 3D lidar, 4 KiB of a serial line 1.4 s of the drive.
  static constexpr std::int64_t kWindowUs = 3'000'000;
  /// Later than any computer is for a whole window, unless it stays so.
  static constexpr Duration kSet = std::chrono::milliseconds(50);

  void take_window(std::int64_t device_us, Duration offset) {
    window_best_ = std::min(window_best_, offset);
    if (device_us - window_begun_us_ < kWindowUs) return;
    if (window_best_ - *offset_ > kSet) offset_ = window_best_;
    begin_window(device_us, offset);
  }
  void begin_window(std::int64_t device_us, Duration offset) {
    window_begun_us_ = device_us;
    window_best_ = offset;
  }

  std::optional<Duration> offset_;
  std::int64_t last_us_ = 0;
  std::int64_t window_begun_us_ = 0;
  Duration window_best_{};
};

}  // namespace madori::sensors
