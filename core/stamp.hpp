#pragma once

#include <chrono>
#include <cmath>

namespace madori {

/// A moment of measurement, nanoseconds since the Unix epoch (or since the start of a log that has no epoch).
using Stamp = std::chrono::time_point<std::chrono::system_clock, std::chrono::nanoseconds>;
using Duration = std::chrono::nanoseconds;

[[nodiscard]] inline double to_seconds(Duration d) {
  return std::chrono::duration<double>(d).count();
}
[[nodiscard]] inline double to_seconds(Stamp t) {
  return to_seconds(t.time_since_epoch());
}

/// Seconds to nanoseconds, rounded; whole seconds are kept exact, so that log stamps of 1e9 s lose no digit.
[[nodiscard]] inline Duration duration_from_seconds(double seconds) {
  const double whole = std::floor(seconds);
  return std::chrono::seconds(static_cast<long long>(whole)) +
         Duration(static_cast<long long>(std::llround((seconds - whole) * 1e9)));
}
[[nodiscard]] inline Stamp stamp_from_seconds(double seconds) {
  return Stamp(duration_from_seconds(seconds));
}

}  // namespace madori
