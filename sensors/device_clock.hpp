#pragma once

#include <cstdint>
#include <optional>

#include "core/stamp.hpp"

namespace madori::sensors {

/// Puts a sensor's own microseconds on the PC's clock. A packet can only arrive late, never early: the
/// smallest difference seen is the best, and it may grow by the drift between two quartz clocks.
class DeviceClock {
 public:
  /// A packet whose data was complete at `device_us` (unwrapped) came at `received`.
  void observe(std::int64_t device_us, Stamp received) {
    const Duration offset = received.time_since_epoch() - std::chrono::microseconds(device_us);
    if (offset_) {
      const auto drift = std::chrono::nanoseconds((device_us - last_us_) * kDriftPpm / 1000);
      offset_ = std::min(offset, *offset_ + std::max(drift, Duration(0)));
    } else {
      offset_ = offset;
    }
    last_us_ = device_us;
  }
  void reset() { offset_.reset(); }
  [[nodiscard]] Stamp stamp_of(std::int64_t device_us) const {
    return Stamp(offset_.value_or(Duration(0)) + std::chrono::microseconds(device_us));
  }

 private:
  static constexpr std::int64_t kDriftPpm = 100;
  std::optional<Duration> offset_;
  std::int64_t last_us_ = 0;
};

}  // namespace madori::sensors
