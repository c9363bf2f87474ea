#pragma once

#include "core/stamp.hpp"
#include "sensors/device_clock.hpp"
#include "sensors/lms1xx/scan_data.hpp"

namespace madori::sensors::lms1xx {

/// Puts the beginnings of scans on the program's clock, and counts the telegrams between that never came.
class ScanClock {
 public:
  /// Of scans that are asked for one by one those between were never meant to come.
  explicit ScanClock(bool polled = false) : polled_(polled) {}

  /// The scan of the telegram before, once more: a scanner that hangs, or is asked faster than it measures.
  [[nodiscard]] bool is_repeated(const ScanData& data) const { return any_ && data.scan_time_us == scan_us_; }
  /// Of a telegram that was complete at `received`: when its first beam was fired.
  [[nodiscard]] Stamp stamp_of(const ScanData& data, Stamp received) {
    const auto step_us =
        static_cast<std::int32_t>(data.transmit_time_us - static_cast<std::uint32_t>(transmit_us_));
    if (any_ && step_us < 0) clock_.reset();
    transmit_us_ = any_ && step_us >= 0 ? transmit_us_ + step_us : data.transmit_time_us;
    clock_.observe(transmit_us_, received);
    const auto missed = static_cast<std::uint16_t>(data.telegram_counter - last_ - 1U);
    if (any_ && !polled_ && missed < 0x8000U) lost_ += missed;
    last_ = data.telegram_counter;
    scan_us_ = data.scan_time_us;
    any_ = true;
    return clock_.stamp_of(transmit_us_ -
                           static_cast<std::int32_t>(data.transmit_time_us - data.scan_time_us));
  }
  void reset() {
    clock_.reset();
    any_ = false;
  }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  bool polled_;
  DeviceClock clock_;
  std::int64_t transmit_us_ = 0;  ///< unwrapped
  std::uint16_t last_ = 0;
  std::uint32_t scan_us_ = 0;
  bool any_ = false;
  std::uint64_t lost_ = 0;
};

}  // namespace madori::sensors::lms1xx
