#pragma once

#include <atomic>
#include <functional>

#include "simulation/devices/device_hub.hpp"
#include "simulation/devices/truth_server.hpp"
#include "simulation/factory.hpp"

namespace madori::simulation {

struct LiveOptions {
  double speed = 1.0;       ///< simulated seconds a second
  double duration_s = 0.0;  ///< simulated; 0: until stopped
};

struct LiveReport {
  double simulated_s = 0.0;
  double wall_s = 0.0;
  double lag_s = 0.0;  ///< time given up because the machine could not keep up
};

/// Runs the factory against the wall clock with its devices on sockets, until the duration is over or `stop`
/// becomes true. `on_truth` is called every 10 ms of simulated time; clients of `truth` hear 20 times a
/// second.
LiveReport run_live(Factory& factory, DeviceHub& hub, TruthServer& truth, const LiveOptions& options,
                    const std::atomic<bool>& stop, const std::function<void(const GroundTruth&)>& on_truth);

}  // namespace madori::simulation
