#pragma once

#include <cmath>

#include "sensors/device_clock.hpp"
#include "sensors/s300/telegram.hpp"

namespace madori::sensors::s300 {

/// Puts the beginnings of scans on the program's clock: a telegram is complete when the 270 deg have been
/// seen and its bytes of ten bits have gone over the line. A scan number that goes back is of a scanner that
/// was switched on anew.
class ScanClock {
 public:
  explicit ScanClock(double baud) : baud_(baud) {}

  [[nodiscard]] Stamp stamp_of(const Telegram& telegram, Stamp received) {
    const std::int64_t scan_us = std::int64_t{telegram.scan_number} * std::llround(kScanPeriodS * 1e6);
    const auto values = static_cast<double>(telegram.values.size());
    const double sweep_s = kScanPeriodS * values * 0.5 / 360.0;
    const double line_s = (26.0 + 2.0 * values) * 10.0 / baud_;
    if (telegram.scan_number < last_scan_) clock_.reset();
    last_scan_ = telegram.scan_number;
    clock_.observe(scan_us + std::llround((sweep_s + line_s) * 1e6), received);
    return clock_.stamp_of(scan_us);
  }
  void reset() { clock_.reset(); }

 private:
  double baud_;
  DeviceClock clock_;
  std::uint32_t last_scan_ = 0;
};

}  // namespace madori::sensors::s300
