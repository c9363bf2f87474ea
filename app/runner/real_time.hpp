#pragma once

#include <atomic>
#include <functional>

#include "app/runner/cycle_times.hpp"
#include "app/runner/transport_run.hpp"

namespace madori::app {

/// Calls `tick` with the time every 20 ms by the steady clock until `stop` or `done()`; a tick that takes
/// longer delays the next one. `times`, where given, gets what each took.
void run_in_real_time(const std::function<void(Stamp)>& tick, const std::atomic<bool>& stop,
                      const std::function<bool()>& done = {}, CycleTimes* times = nullptr);

/// Ticks `run` every 20 ms by the steady clock until `stop` or `done()`. A step that takes longer delays the
/// next one; the drive stops by itself after 200 ms of silence.
void run_in_real_time(TransportRun& run, const std::atomic<bool>& stop,
                      const std::function<bool()>& done = {});

}  // namespace madori::app
