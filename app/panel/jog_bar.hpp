#pragma once

#include <mutex>
#include <optional>

#include "core/stamp.hpp"
#include "core/velocity_command.hpp"

namespace madori::app {

/// After a Stop nobody drives by hand before every button that was held has been let go: a held one repeats
/// itself every 80 ms, on whichever panel, and would start the vehicle again.
class JogBar {
 public:
  void bar() {
    const std::scoped_lock lock(mutex_);
    barred_ = true;
  }
  /// Whether this may be driven at `now`.
  [[nodiscard]] bool allows(const VelocityCommand& velocity, Stamp now) {
    if (velocity == VelocityCommand{}) return true;
    const std::scoped_lock lock(mutex_);
    const bool held_on = held_ && to_seconds(now - *held_) < kReleased_s;
    held_ = now;
    barred_ = barred_ && held_on;
    return !barred_;
  }

 private:
  static constexpr double kReleased_s = 0.5;
  std::mutex mutex_;
  bool barred_ = false;
  std::optional<Stamp> held_;  ///< when a button was last held
};

}  // namespace madori::app
