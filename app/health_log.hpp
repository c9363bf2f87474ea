#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/pose_estimate.hpp"

namespace madori::app {

/// The health along a run: how much of the time in which state, and a line a record.
class HealthLog {
 public:
  void add(const PoseEstimate& estimate);

  /// `timestamp,state,reason`, a line a record in the order they came.
  [[nodiscard]] const std::string& csv() const { return csv_; }
  /// Shares of the time, the last state and its reason.
  [[nodiscard]] nlohmann::json json() const;
  /// The same in a line for people.
  [[nodiscard]] std::string summary() const;
  /// Share of the time in a state, 0..1.
  [[nodiscard]] double share(LocalizationState state) const;

 private:
  std::string csv_ = "timestamp,state,reason\n";
  std::array<double, 4> seconds_{};
  PoseEstimate last_;
  bool started_ = false;
};

}  // namespace madori::app
