#include "planning/obstacle_check/sight_history.hpp"

namespace madori::planning {
namespace {

constexpr double kViewSlackM = 0.03;

}  // namespace

SensorView SensorView::of(const LidarModel& lidar) {
  const auto& at = lidar.mounting;
  return {at.x_m,
          at.y_m,
          at.z_m,
          lidar.min_elevation_rad,
          lidar.max_elevation_rad,
          at.yaw_rad + 0.5 * (lidar.from_rad + lidar.to_rad),
          0.5 * (lidar.to_rad - lidar.from_rad)};
}

bool SensorView::looks_at(double bearing_rad) const {
  return half_view_rad >= kPi || std::abs(wrap_angle(bearing_rad - facing_rad)) <= half_view_rad;
}

bool SensorView::sees(const Point2<Base>& place, double low_m, double high_m) const {
  if (half_view_rad < kPi && !looks_at(std::atan2(place.y_m - y_m, place.x_m - x_m))) return false;
  // What a level lidar has seen lies in its plane, and is as high as the floor is uneven.
  if (min_elevation_rad == max_elevation_rad)
    return low_m <= z_m + kViewSlackM && high_m >= z_m - kViewSlackM;
  const double away_m = std::hypot(place.x_m - x_m, place.y_m - y_m);
  return high_m >= z_m + away_m * std::tan(min_elevation_rad) + kViewSlackM &&
         low_m <= z_m + away_m * std::tan(max_elevation_rad);
}

const SightHistory::Sight* SightHistory::last_of(const SensorView& view) const {
  for (std::size_t i = sights_.size(); i-- > 0;)
    if (sights_[i].view == view) return &sights_[i];
  return nullptr;
}

bool SightHistory::begin(const SensorView& view, const Transform2<Odom, Base>& odom_from_base, Stamp stamp) {
  const Sight* last = last_of(view);
  if (last != nullptr && stamp < last->stamp) {
    sights_.clear();  // the clock was set
    last = nullptr;
  }
  if (last != nullptr && to_seconds(stamp - last->stamp) < options_.apart_s) return false;
  while (!sights_.empty() && to_seconds(stamp - sights_.front().stamp) > options_.memory_s)
    sights_.pop_front();
  Sight& sight = sights_.add();
  sight.stamp = stamp;
  sight.base_from_odom = odom_from_base.inverse();
  sight.view = view;
  sight.nearest_m.assign(kDirections, -1.0F);
  return true;
}

bool SightHistory::shows_empty(const Sight& sight, const Point2<Odom>& place, double side_m, double low_m,
                               double high_m) const {
  const Point2<Base> at = sight.base_from_odom * place;
  if (!sight.view.sees(at, low_m, high_m)) return false;
  const double x = at.x_m - sight.view.x_m;
  const double y = at.y_m - sight.view.y_m;
  const double away_m = std::hypot(x, y);
  if (away_m < side_m) return false;
  const double half = 0.5 * side_m / away_m;  // of the square, across the line of sight
  const std::size_t first = direction(x + half * y, y - half * x);
  const std::size_t last = direction(x - half * y, y + half * x);
  bool known = false;
  for (std::size_t i = first;; i = (i + 1) % kDirections) {
    if (sight.nearest_m[i] >= 0.0F) {
      if (static_cast<double>(sight.nearest_m[i]) < away_m + options_.margin_m) return false;
      known = true;
    }
    if (i == last) return known;
  }
}

bool SightHistory::was_empty(const Point2<Odom>& place, double side_m, double low_m, double high_m,
                             Stamp now) const {
  int empty = 0;
  for (const Sight& sight : sights_) {
    if (to_seconds(now - sight.stamp) < options_.youngest_s) continue;
    if (shows_empty(sight, place, side_m, low_m, high_m)) ++empty;
    if (empty >= options_.fewest_scans) return true;
  }
  return false;
}

}  // namespace madori::planning
