#pragma once

#include <atomic>
#include <csignal>
#include <initializer_list>

namespace madori::app {

/// Set once one of these signals (SIGINT, SIGTERM, SIGHUP) comes, from this call on; one flag for the whole
/// program. A closed terminal ends nothing that was started with nohup.
[[nodiscard]] inline const std::atomic<bool>& interrupted_by(std::initializer_list<int> signals) {
  static constinit std::atomic<bool> interrupted = false;  // NOLINT: a signal handler reaches nothing else
  for (const int number : signals) {
    const auto before = std::signal(number, [](int) { interrupted = true; });
    if (number == SIGHUP && before == SIG_IGN) std::signal(number, SIG_IGN);
  }
  return interrupted;
}

}  // namespace madori::app
