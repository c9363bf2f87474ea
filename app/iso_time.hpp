#pragma once

#include <string>

namespace madori::app {

/// Now, as 2026-01-31T12:34:56Z.
[[nodiscard]] std::string iso_time_utc();
/// A time of day, seconds since 1970.
[[nodiscard]] std::string iso_time_of(double stamp_s);

}  // namespace madori::app
