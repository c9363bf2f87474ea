#pragma once

#include <string>

#include "app/cycle/drive_faults.hpp"
#include "app/cycle/notice.hpp"
#include "hmi/server/vehicle.hpp"
#include "localization/health/reasons.hpp"

namespace madori::app {

/// A sentence that no catalogue knows.
[[nodiscard]] inline hmi::Notice uncoded(const std::string& text) {
  return text.empty() ? hmi::Notice{} : hmi::Notice{"", {}, text};
}

/// The cycle's notice as the panel's. Where its {reason} is one of localization, or its {faults} are the
/// drive's, `reason_codes` and `fault_codes` let the panel say them in its own language.
[[nodiscard]] inline hmi::Notice shown(const Notice& notice) {
  hmi::Notice all{notice.code, notice.values, notice.text};
  if (const auto reason = all.values.find("reason"); reason != all.values.end())
    all.values["reason_codes"] = localization::reason_codes(reason->second);
  if (const auto faults = all.values.find("faults"); faults != all.values.end())
    all.values["fault_codes"] = fault_codes(faults->second);
  return all;
}

}  // namespace madori::app
