#pragma once

#include <atomic>
#include <csignal>
#include <initializer_list>

namespace madori::app {

/// Set once one of these signals (SIGINT, SIGTERM) comes, from this call on; one flag for the whole program.
[[nodiscard]] inline const std::atomic<bool>& interrupted_by(std::initializer_list<int> signals) {
  static constinit std::atomic<bool> interrupted = false;  // NOLINT: a signal handler reaches nothing else
  for (const int number : signals) std::signal(number, [](int) { interrupted = true; });
  return interrupted;
}

}  // namespace madori::app
