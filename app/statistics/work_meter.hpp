#pragma once

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <stop_token>
#include <thread>

#include "app/cycle/cycle.hpp"
#include "app/statistics/statistics_store.hpp"

namespace madori::app {

/// Counts what the vehicle does, step by step, and writes the sums to madori.db every few seconds from a
/// thread of its own: the cycle never waits for the disk.
class WorkMeter {
 public:
  explicit WorkMeter(const std::filesystem::path& database);
  /// Writes what is left.
  ~WorkMeter();
  WorkMeter(const WorkMeter&) = delete;
  WorkMeter& operator=(const WorkMeter&) = delete;

  /// On the cycle's thread, after every step.
  void count(const CycleInput& input, const CycleState& state);
  /// The next step begins anew: another run, whose odometry starts elsewhere.
  void forget_step() { previous_.reset(); }
  /// All since the site began, with what is not written yet. From any thread.
  [[nodiscard]] Work sums() const;
  [[nodiscard]] std::optional<Stamp> since() const;

 private:
  void run(const std::stop_token& stop);
  void write();

  struct Step {
    Stamp now;
    Transform2<Odom, Base> odom_from_base;
    std::string cause;
  };
  StatisticsStore store_;
  std::optional<Step> previous_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  Work written_;
  Work waiting_;
  Stamp now_{};
  std::optional<Stamp> since_;
  std::jthread thread_;
};

}  // namespace madori::app
