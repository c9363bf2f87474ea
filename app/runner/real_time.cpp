#include "app/runner/real_time.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include "app/runner/clock_words.hpp"
#include "core/thread_role.hpp"

namespace madori::app {

void run_in_real_time(const std::function<void(Stamp)>& tick, const std::atomic<bool>& stop,
                      const RealTimeHooks& hooks, Clock& clock) {
  constexpr Duration kPeriod = std::chrono::milliseconds(20);
  const bool first = take_role("cycle", ThreadRole::Cycle);
  if (hooks.placed) hooks.placed(first);
  Stamp next = clock.now();
  while (!stop && !(hooks.done && hooks.done())) {
    for (const ClockJump& jump : clock.watch())
      if (hooks.told) hooks.told(in_words(jump));
    const auto begun = CycleTimes::Clock::now();
    const Stamp due = next;
    const Stamp late_from = clock.now();
    tick(late_from);
    if (hooks.came_round) hooks.came_round();
    const Stamp now = clock.now();
    if (hooks.times != nullptr) hooks.times->add(begun - (late_from - due), begun, CycleTimes::Clock::now());
    next = std::max(due + kPeriod, now);
    // For a time, not until a moment: a clock that goes back must not make it long.
    std::this_thread::sleep_for(next - now);
  }
  (void)take_role("madori", ThreadRole::Ordinary);
}

}  // namespace madori::app
