#include "app/runner/real_time.hpp"

#include <chrono>
#include <thread>

namespace madori::app {

void run_in_real_time(const std::function<void(Stamp)>& tick, const std::atomic<bool>& stop,
                      const std::function<bool()>& done, CycleTimes* times) {
  constexpr auto kPeriod = std::chrono::milliseconds(20);
  auto next = std::chrono::steady_clock::now();
  while (!stop && !(done && done())) {
    const auto begun = std::chrono::steady_clock::now();
    tick(std::chrono::system_clock::now());
    const auto now = std::chrono::steady_clock::now();
    if (times != nullptr) times->add(next, begun, now);
    next += kPeriod;
    if (next < now) next = now;
    std::this_thread::sleep_until(next);
  }
}

void run_in_real_time(TransportRun& run, const std::atomic<bool>& stop, const std::function<bool()>& done) {
  run_in_real_time([&run](Stamp now) { run.tick(now); }, stop, done);
}

}  // namespace madori::app
