#pragma once

#include <cmath>

#include "core/transform2.hpp"
#include "core/velocity_command.hpp"

namespace madori::test {

/// A vehicle without dynamics but a first-order motor lag, for tests of control alone.
class RollingVehicle {
 public:
  explicit RollingVehicle(Transform2<Map, Base> pose, double lag_s = 0.1) : pose_(pose), lag_s_(lag_s) {}

  /// Something holds it: its wheels slip, also forward alone, or are blocked.
  enum class Held { No, Slipping, Blocked, Ahead };
  Held held = Held::No;

  void move(const VelocityCommand& command, double step_s) {
    const double share = 1.0 - std::exp(-step_s / lag_s_);
    speed_.linear_mps += share * (command.linear_mps - speed_.linear_mps);
    speed_.angular_radps += share * (command.angular_radps - speed_.angular_radps);
    if (held == Held::Blocked) speed_ = {};
    if (held == Held::Slipping || held == Held::Blocked) return;
    if (held == Held::Ahead && speed_.linear_mps > 0.0) return;
    const double turn = speed_.angular_radps * step_s;
    const double way = speed_.linear_mps * step_s;
    pose_ = pose_ * Transform2<Base, Base>(way * std::cos(turn / 2.0), way * std::sin(turn / 2.0), turn);
  }

  /// Carries it there.
  void set_pose(const Transform2<Map, Base>& pose) { pose_ = pose; }

  [[nodiscard]] const Transform2<Map, Base>& pose() const { return pose_; }
  [[nodiscard]] const VelocityCommand& speed() const { return speed_; }

 private:
  Transform2<Map, Base> pose_;
  VelocityCommand speed_;
  double lag_s_;
};

}  // namespace madori::test
