#include "app/runner/real_time.hpp"

#include <chrono>
#include <thread>

namespace madori::app {

void run_in_real_time(TransportRun& run, const std::atomic<bool>& stop, const std::function<bool()>& done) {
  constexpr auto kPeriod = std::chrono::milliseconds(20);
  auto next = std::chrono::steady_clock::now();
  while (!stop && !(done && done())) {
    run.tick(std::chrono::system_clock::now());
    next += kPeriod;
    const auto now = std::chrono::steady_clock::now();
    if (next < now) next = now;
    std::this_thread::sleep_until(next);
  }
}

}  // namespace madori::app
