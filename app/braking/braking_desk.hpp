#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include "app/braking/braking_test.hpp"
#include "app/braking/braking_verdict.hpp"

namespace madori::app {

/// The braking tests of a vehicle and what they have measured so far: asked by panels or the command, driven
/// by the cycle's thread. All members from any thread.
class BrakingDesk {
 public:
  struct View {
    bool running = false;
    std::size_t stops_now = 0;  ///< of the test that runs or ran last
    Notice trouble;             ///< why the last test ended early
    std::vector<BrakingStop> stops;
  };

  static constexpr int kStops = 3;

  /// False while one runs. The stops of an earlier test with the same load are measured anew.
  bool start(const BrakingPlan& plan, bool loaded);
  /// After each step of the cycle: what to say to it.
  [[nodiscard]] std::vector<OperatorCommand> after_step(const CycleInput& input, const CycleState& state,
                                                        const CycleConfig& config);
  [[nodiscard]] View view() const;

 private:
  mutable std::mutex mutex_;
  std::optional<BrakingTest> test_;
  bool loaded_ = false;
  std::vector<BrakingStop> stops_;  ///< of tests that ended well, with these wheels:
  double wheel_radius_m_ = 0.0;
};

}  // namespace madori::app
