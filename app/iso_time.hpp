#pragma once

#include <string>

namespace madori::app {

/// Now, as 2026-01-31T12:34:56Z.
[[nodiscard]] std::string iso_time_utc();

}  // namespace madori::app
