#include "localization/mounting/wheel_path.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace madori::localization {

WheelPath::WheelPath(std::vector<WheelReading> readings, const WheelGeometry& wheels)
    : wheels_(wheels), readings_(std::move(readings)) {
  poses_.resize(readings_.size());
  for (std::size_t i = 1; i < readings_.size(); ++i) {
    const auto step = arc_step(wheels_, readings_[i].left_rad - readings_[i - 1].left_rad,
                               readings_[i].right_rad - readings_[i - 1].right_rad);
    poses_[i] = poses_[i - 1] * step;
    turned_rad_ += std::abs(step.yaw_rad());
    driven_m_ += std::hypot(step.x_m(), step.y_m());
  }
}

std::size_t WheelPath::first_after(Stamp moment) const {
  return static_cast<std::size_t>(std::ranges::upper_bound(readings_, moment, {}, &WheelReading::stamp) -
                                  readings_.begin());
}

WheelReading WheelPath::reading_at(Stamp moment) const {
  const std::size_t after = first_after(moment);
  if (after == 0) return readings_.front();
  if (after == readings_.size()) return readings_.back();
  const WheelReading& a = readings_[after - 1];
  const WheelReading& b = readings_[after];
  const double share = to_seconds(moment - a.stamp) / to_seconds(b.stamp - a.stamp);
  return {moment, a.left_rad + share * (b.left_rad - a.left_rad),
          a.right_rad + share * (b.right_rad - a.right_rad)};
}

Transform2<Odom, Base> WheelPath::at(Stamp moment) const {
  if (readings_.empty()) return {};
  const std::size_t after = first_after(moment);
  const std::size_t before = after == 0 ? 0 : after - 1;
  const WheelReading here = reading_at(moment);
  return poses_[before] * arc_step(wheels_, here.left_rad - readings_[before].left_rad,
                                   here.right_rad - readings_[before].right_rad);
}

std::vector<std::array<double, 2>> WheelPath::pieces(Stamp from, Stamp to) const {
  std::vector<std::array<double, 2>> all;
  if (readings_.empty()) return all;
  WheelReading last = reading_at(from);
  const auto add = [&](const WheelReading& next) {
    all.push_back({next.left_rad - last.left_rad, next.right_rad - last.right_rad});
    last = next;
  };
  for (std::size_t i = first_after(from); i < readings_.size() && readings_[i].stamp < to; ++i)
    add(readings_[i]);
  add(reading_at(to));
  return all;
}

}  // namespace madori::localization
