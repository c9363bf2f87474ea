#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace madori::app {

/// Seconds counted by how long they were, as Prometheus histograms are. One thread adds, any may read.
class TimeHistogram {
 public:
  static constexpr std::array kBounds_s{0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5};

  void add(double seconds);
  /// Text exposition format 0.0.4 of this one, `name` and `help` as Prometheus wants them.
  [[nodiscard]] std::string prometheus(const std::string& name, const std::string& help) const;

 private:
  std::array<std::atomic<std::uint64_t>, kBounds_s.size() + 1> counts_{};
  std::atomic<double> sum_s_ = 0.0;
};

/// When each step of the cycle was due, how late it began and how long it took: for measuring that nothing
/// disturbs it. Nothing touches the disk before write().
class CycleTimes {
 public:
  using Clock = std::chrono::steady_clock;

  /// `keep_each`: twelve bytes a step, for write(); else they are only counted.
  explicit CycleTimes(bool keep_each) : keep_each_(keep_each) {}

  void add(Clock::time_point due, Clock::time_point begun, Clock::time_point ended);
  [[nodiscard]] std::size_t size() const { return steps_.size(); }
  /// CSV: `due_s` (CLOCK_MONOTONIC), `late_ms`, `step_ms`. Throws Error where it cannot be written.
  void write(const std::filesystem::path& file) const;
  /// How late the steps began and how long they took, for Prometheus. From any thread.
  [[nodiscard]] std::string prometheus() const;

 private:
  struct Step {
    float since_first_s;
    float late_ms;
    float step_ms;
  };
  bool keep_each_;
  Clock::time_point first_{};
  std::vector<Step> steps_;
  TimeHistogram late_;
  TimeHistogram step_;
};

}  // namespace madori::app
