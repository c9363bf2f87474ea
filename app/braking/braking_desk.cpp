#include "app/braking/braking_desk.hpp"

#include <algorithm>
#include <utility>

namespace madori::app {

bool BrakingDesk::start(const BrakingPlan& plan, bool loaded) {
  const std::scoped_lock lock(mutex_);
  if (test_ && !test_->ended()) return false;
  loaded_ = loaded;
  test_.emplace(plan);
  return true;
}

std::vector<OperatorCommand> BrakingDesk::after_step(const CycleInput& input, const CycleState& state,
                                                     const CycleConfig& config) {
  const std::scoped_lock lock(mutex_);
  // Encoders tell angles: of wheels that were corrected since, no stop is known.
  if (std::exchange(wheel_radius_m_, config.odometry.wheels.left_radius_m) !=
      config.odometry.wheels.left_radius_m)
    stops_.clear();
  if (!test_ || test_->ended()) return {};
  auto words = test_->after_step(input, state, config);
  if (!test_->ended() || !test_->trouble().empty()) return words;
  std::erase_if(stops_, [&](const BrakingStop& s) { return s.loaded == loaded_; });
  for (const auto& stop : test_->stops()) stops_.push_back({loaded_, stop});
  return words;
}

BrakingDesk::View BrakingDesk::view() const {
  const std::scoped_lock lock(mutex_);
  if (!test_) return {};
  return {!test_->ended(), test_->stops().size(), test_->trouble(), stops_};
}

}  // namespace madori::app
