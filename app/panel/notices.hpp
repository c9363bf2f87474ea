#pragma once

#include <string>

#include "app/cycle/notice.hpp"
#include "hmi/server/vehicle.hpp"

namespace madori::app {

/// A sentence that no catalogue knows.
[[nodiscard]] inline hmi::Notice uncoded(const std::string& text) {
  return text.empty() ? hmi::Notice{} : hmi::Notice{"", {}, text};
}

/// The cycle's notice as the panel's.
[[nodiscard]] inline hmi::Notice shown(const Notice& notice) {
  return {notice.code, notice.values, notice.text};
}

}  // namespace madori::app
