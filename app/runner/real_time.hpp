#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "app/runner/cycle_times.hpp"
#include "app/runner/transport_run.hpp"
#include "core/clock.hpp"

namespace madori::app {

/// What run_in_real_time does besides ticking.
struct RealTimeHooks {
  std::function<bool()> done;                         ///< ends it, as `stop` does
  std::function<void(const std::string& text)> told;  ///< what the computer's clocks did, in words
  std::function<void(bool first)> placed =
      nullptr;  ///< once, at the beginning: whether it comes before ordinary work
  std::function<void()> came_round = nullptr;  ///< after each tick
  CycleTimes* times = nullptr;                 ///< gets what each tick took
};

/// Calls `tick` with the time of `clock` every 20 ms until `stop` or `done()`; a tick that takes longer
/// delays the next one: the drive stops by itself after 200 ms of silence.
void run_in_real_time(const std::function<void(Stamp)>& tick, const std::atomic<bool>& stop,
                      const RealTimeHooks& hooks = {}, Clock& clock = computer_clock());

}  // namespace madori::app
