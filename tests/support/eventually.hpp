#pragma once

#include <chrono>
#include <thread>

namespace madori::test {

/// Waits for other threads and sockets: true as soon as `condition` holds, false after 10 s. Tests assert on
/// what happened, never on how long it took.
template <class Condition>
bool eventually(Condition condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (std::chrono::steady_clock::now() < end) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return false;
}

}  // namespace madori::test
