#include "sensors/deskew.hpp"

#include <algorithm>
#include <array>

#include "core/angle.hpp"

namespace madori::sensors {
namespace {

/// Knots of the sweep's motion: between two of them (3 ms of a 10 Hz sweep) it counts as even.
constexpr std::size_t kKnots = 33;

}  // namespace

void OdometryTrack::add(const OdometryReading& reading) {
  if (!readings_.empty() && reading.stamp <= readings_.back().stamp) return;
  readings_.push_back(reading);
  while (reading.stamp - readings_.front().stamp > length_) readings_.pop_front();
}

bool OdometryTrack::covers(Stamp from, Stamp to) const {
  return !readings_.empty() && readings_.front().stamp <= from && to <= readings_.back().stamp;
}

std::optional<Transform2<Odom, Base>> OdometryTrack::at(Stamp stamp) const {
  if (!covers(stamp, stamp)) return std::nullopt;
  const auto after = std::lower_bound(readings_.begin(), readings_.end(), stamp,
                                      [](const OdometryReading& r, Stamp s) { return r.stamp < s; });
  if (after->stamp == stamp) return after->odom_from_base;
  const OdometryReading& a = *(after - 1);
  const double share = to_seconds(stamp - a.stamp) / to_seconds(after->stamp - a.stamp);
  const auto &p = a.odom_from_base, &q = after->odom_from_base;
  return Transform2<Odom, Base>(p.x_m() + share * (q.x_m() - p.x_m()), p.y_m() + share * (q.y_m() - p.y_m()),
                                p.yaw_rad() + share * wrap_angle(q.yaw_rad() - p.yaw_rad()));
}

bool deskew(PointCloud<Lidar>& cloud, const Transform2<Base, Lidar>& base_from_lidar,
            const OdometryTrack& track) {
  float last_s = 0.0F;
  for (const CloudPoint& point : cloud.points) last_s = std::max(last_s, point.time_offset_s);
  if (!track.covers(cloud.stamp, cloud.stamp + duration_from_seconds(last_s))) return false;
  if (last_s <= 0.0F) return true;
  const auto start = *track.at(cloud.stamp) * base_from_lidar;
  std::array<Transform2<Lidar, Lidar>, kKnots> knots;
  for (std::size_t k = 0; k < kKnots; ++k) {
    const double offset_s = static_cast<double>(last_s) * static_cast<double>(k) / (kKnots - 1);
    const auto pose = track.at(cloud.stamp + duration_from_seconds(offset_s));
    knots[k] = start.inverse() * (pose.value_or(*track.at(cloud.stamp)) * base_from_lidar);
  }
  for (CloudPoint& point : cloud.points) {
    const double place =
        static_cast<double>(point.time_offset_s) / static_cast<double>(last_s) * (kKnots - 1);
    const std::size_t k = std::min(static_cast<std::size_t>(std::max(place, 0.0)), kKnots - 2);
    const double share = place - static_cast<double>(k);
    const Point2<Lidar> seen{static_cast<double>(point.x_m), static_cast<double>(point.y_m)};
    const Point2<Lidar> a = knots[k] * seen, b = knots[k + 1] * seen;
    point.x_m = static_cast<float>(a.x_m + share * (b.x_m - a.x_m));
    point.y_m = static_cast<float>(a.y_m + share * (b.y_m - a.y_m));
  }
  return true;
}

}  // namespace madori::sensors
