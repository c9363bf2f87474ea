#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <stop_token>
#include <string>
#include <thread>

namespace madori::app {

struct WatchdogOptions {
  std::chrono::milliseconds hung_after{1000};  ///< the drive has stopped by itself long before
  std::chrono::milliseconds look_every{100};
  std::chrono::milliseconds notify_every{1000};  ///< systemd, which waits for several of them
  std::function<void(const std::string&)> told;  ///< on the watchdog's thread
};

/// Sees from a thread of its own that another one comes round, and says so to systemd (WatchdogSec=), which
/// starts a program anew that does not. One that hangs is named, with what it does meanwhile.
class Watchdog {
 public:
  /// Watches the calling thread.
  explicit Watchdog(WatchdogOptions options);

  /// From the watched thread, each time that it comes round.
  void beat() { beat_ns_.store(now_ns(), std::memory_order_relaxed); }

 private:
  [[nodiscard]] static long long now_ns();
  void watch(const std::stop_token& stop);

  WatchdogOptions options_;
  int watched_;  ///< its number in the system
  std::atomic<long long> beat_ns_;
  std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace madori::app
