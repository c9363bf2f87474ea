#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace madori::bench {

struct BentTrialOptions {
  std::string source = "localizer";
  std::string sensor = "vlp16";  ///< or scan
  double amplitude_m = 0.3;
  std::uint32_t seed = 1;
  double metres = 100.0;
  bool tap = true;  ///< the place is given once, 0.3 m and 6 degrees off
};

/// Drives through one random bent building by the truth while a localizer looks on, and hands out its
/// figures: seconds by state from the first place on, seconds LOCALIZED but more than 1 m off, errors on the
/// drawing against the known warp, and twice a second a sample of what was said beside what was right.
[[nodiscard]] nlohmann::json drive_bent_building(const BentTrialOptions& options);

}  // namespace madori::bench
