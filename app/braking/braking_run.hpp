#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <vector>

#include "app/braking/braking_verdict.hpp"
#include "app/runner/socket_link.hpp"

namespace madori::app {

struct BrakingRunOptions {
  std::filesystem::path site;
  SocketOptions devices;
  double speed_mps = 0.0;  ///< 0: the site's top speed
  int stops = 3;
  std::function<bool()> load;  ///< puts the load on for a second series; false: there is none. Empty: none
};

/// Drives the braking test on the vehicle's devices and returns the stops. Throws Error where it ended early,
/// with what was in its way. `interrupted` ends it: the drive stops by itself when its commands stop.
[[nodiscard]] std::vector<BrakingStop> run_braking_test(const BrakingRunOptions& options,
                                                        const std::atomic<bool>& interrupted);

/// Writes the measured values into site.yaml, as a version of the site. Throws Error as with_measured() does.
void take_over(const std::filesystem::path& site, const BrakingVerdict& verdict, bool lower_speed);

}  // namespace madori::app
