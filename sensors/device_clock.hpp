#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/stamp.hpp"

namespace madori::sensors {

/// Puts a sensor's own microseconds on the program's clock. A packet can only arrive late, never early: the
/// smallest difference seen is the best, and it may grow by the drift between two quartz clocks. Where every
/// packet of a whole window comes later than that, one of the two clocks was set: the window's best counts. A
/// backlog of a computer that stood still tells nothing: it is read faster than it was measured.
class DeviceClock {
 public:
  /// A packet whose data was complete at `device_us` (unwrapped) came at `received`.
  void observe(std::int64_t device_us, Stamp received) {
    const Duration offset = received.time_since_epoch() - std::chrono::microseconds(device_us);
    if (offset_) {
      const auto drift = std::chrono::nanoseconds((device_us - last_us_) * kDriftPpm / 1000);
      offset_ = std::min(offset, *offset_ + std::max(drift, Duration(0)));
      take_window(device_us, received, offset);
    } else {
      offset_ = offset;
      begin_window(device_us, received, offset);
    }
    last_us_ = device_us;
  }
  void reset() { offset_.reset(); }
  [[nodiscard]] Stamp stamp_of(std::int64_t device_us) const {
    return Stamp(offset_.value_or(Duration(0)) + std::chrono::microseconds(device_us));
  }

 private:
  static constexpr std::int64_t kDriftPpm = 100;
  static constexpr std::int64_t kWindowUs = 3'000'000;  ///< by the device's clock
  /// Later than any computer is for a whole window, unless it stays so.
  static constexpr Duration kSet = std::chrono::milliseconds(50);

  void take_window(std::int64_t device_us, Stamp received, Duration offset) {
    window_best_ = std::min(window_best_, offset);
    const std::chrono::microseconds measured(device_us - window_begun_us_);
    if (measured.count() < kWindowUs) return;
    const bool is_backlog = received - window_begun_ < measured / 2;
    if (!is_backlog && window_best_ - *offset_ > kSet) offset_ = window_best_;
    begin_window(device_us, received, offset);
  }
  void begin_window(std::int64_t device_us, Stamp received, Duration offset) {
    window_begun_us_ = device_us;
    window_begun_ = received;
    window_best_ = offset;
  }

  std::optional<Duration> offset_;
  std::int64_t last_us_ = 0;
  std::int64_t window_begun_us_ = 0;
  Stamp window_begun_{};
  Duration window_best_{};
};

}  // namespace madori::sensors
