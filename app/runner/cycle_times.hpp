#pragma once

#include <chrono>
#include <filesystem>
#include <vector>

namespace madori::app {

/// When each step of the cycle was due, how late it began and how long it took: for measuring that nothing
/// disturbs it. Twelve bytes a step; nothing touches the disk before write().
class CycleTimes {
 public:
  using Clock = std::chrono::steady_clock;

  void add(Clock::time_point due, Clock::time_point begun, Clock::time_point ended);
  [[nodiscard]] std::size_t size() const { return steps_.size(); }
  /// CSV: `due_s` (CLOCK_MONOTONIC), `late_ms`, `step_ms`. Throws Error where it cannot be written.
  void write(const std::filesystem::path& file) const;

 private:
  struct Step {
    float since_first_s;
    float late_ms;
    float step_ms;
  };
  Clock::time_point first_{};
  std::vector<Step> steps_;
};

}  // namespace madori::app
