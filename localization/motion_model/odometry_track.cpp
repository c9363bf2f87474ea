#include "localization/motion_model/odometry_track.hpp"

#include <algorithm>

namespace madori::localization {
namespace {

/// Along the straight line from a to b; f beyond 1 carries on.
OdometryReading blend(const OdometryReading& a, const OdometryReading& b, Stamp stamp) {
  const double span = to_seconds(b.stamp - a.stamp);
  const double f = span > 0.0 ? to_seconds(stamp - a.stamp) / span : 1.0;
  const Transform2<Base, Base> step = a.odom_from_base.inverse() * b.odom_from_base;
  return {stamp,
          a.odom_from_base * Transform2<Base, Base>(f * step.x_m(), f * step.y_m(), f * step.yaw_rad())};
}

bool earlier(const OdometryReading& reading, Stamp stamp) {
  return reading.stamp < stamp;
}

}  // namespace

std::optional<Transform2<Base, Base>> OdometryTrack::follow(const OdometryReading& reading) {
  const OdometryReading before = empty() ? reading : newest();
  if (!add(reading)) return std::nullopt;
  return before.odom_from_base.inverse() * reading.odom_from_base;
}

bool OdometryTrack::add(const OdometryReading& reading) {
  if (!reading.odom_from_base.is_finite() || (!readings_.empty() && reading.stamp < newest().stamp)) {
    return false;
  }
  readings_.push_back(reading);
  while (readings_.size() > 2 && reading.stamp - readings_[1].stamp > kKept) {
    readings_.pop_front();
  }
  return true;
}

std::optional<OdometryReading> OdometryTrack::at(Stamp stamp) const {
  const auto after = std::lower_bound(readings_.begin(), readings_.end(), stamp, earlier);
  if (after != readings_.end()) {
    if (after->stamp == stamp || after == readings_.begin()) {
      return after->stamp - stamp <= kCarryOn ? std::optional(*after) : std::nullopt;
    }
    return blend(*std::prev(after), *after, stamp);
  }
  if (readings_.empty() || stamp - newest().stamp > kCarryOn) {
    return std::nullopt;
  }
  if (readings_.size() < 2 || newest().stamp - readings_[readings_.size() - 2].stamp > kCarryOn) {
    return OdometryReading{stamp, newest().odom_from_base};
  }
  return blend(readings_[readings_.size() - 2], newest(), stamp);
}

Transform2<Odom, Base> OdometryTrack::clipped(Stamp stamp) const {
  if (stamp <= readings_.front().stamp) return readings_.front().odom_from_base;
  return at(std::min(stamp, newest().stamp + kCarryOn)).value_or(newest()).odom_from_base;
}

OdometryStep OdometryTrack::between(Stamp from, Stamp to, const OdometryModel& model) const {
  OdometryStep step;
  if (readings_.empty() || to <= from) {
    return step;
  }
  Transform2<Odom, Base> last = clipped(from);
  const auto extend = [&](const Transform2<Odom, Base>& next) {
    model.extend(step, last.inverse() * next);
    last = next;
  };
  auto i = std::upper_bound(readings_.begin(), readings_.end(), from,
                            [](Stamp stamp, const OdometryReading& r) { return stamp < r.stamp; });
  for (; i != readings_.end() && i->stamp < to; ++i) {
    extend(i->odom_from_base);
  }
  extend(clipped(to));
  return step;
}

}  // namespace madori::localization
