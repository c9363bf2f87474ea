#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/angle.hpp"
#include "core/frames.hpp"
#include "core/lidar_model.hpp"
#include "core/ring.hpp"
#include "core/stamp.hpp"
#include "core/transform2.hpp"

namespace madori::planning {

/// Which places and heights a sensor can see, Base frame. A 2D lidar has both elevations zero.
struct SensorView {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double min_elevation_rad = 0.0;
  double max_elevation_rad = 0.0;
  double facing_rad = 0.0;     ///< the middle of its field of view
  double half_view_rad = kPi;  ///< to each side of it

  /// Of a lidar on the vehicle.
  [[nodiscard]] static SensorView of(const LidarModel& lidar);
  /// Whether the bearing from the sensor lies in its field of view.
  [[nodiscard]] bool looks_at(double bearing_rad) const;
  /// Whether something from `low_m` to `high_m` above the floor would be hit by this sensor at that place.
  [[nodiscard]] bool sees(const Point2<Base>& place, double low_m, double high_m) const;

  friend bool operator==(const SensorView&, const SensorView&) = default;
};

struct SightOptions {
  double memory_s = 1.5;    ///< what was seen longer ago is forgotten
  double apart_s = 0.15;    ///< between two scans of one sensor that are kept
  double youngest_s = 0.3;  ///< scans more recent than this are not asked
  int fewest_scans = 2;     ///< that must have seen a place empty
  double margin_m = 0.25;   ///< before the nearest thing: noise of the ranges, corners of the cells
};

/// What the last scans saw to be empty: for every direction the nearest thing that is no floor. What stands
/// now where they saw through has come there; what merely came into sight has not.
class SightHistory {
 public:
  /// One scan.
  struct Sight {
    Stamp stamp{};
    Transform2<Base, Odom> base_from_odom;
    SensorView view;
    std::vector<float> nearest_m;  ///< by direction; negative where no ray returned
  };

  explicit SightHistory(const SightOptions& options = {}) : options_(options) {}

  /// Begins a scan; whether it is kept, and add() wanted. Each sensor's scans are kept for themselves: what
  /// one has seen says nothing of where only another one looks, and they come in no order of their stamps.
  bool begin(const SensorView& view, const Transform2<Odom, Base>& odom_from_base, Stamp stamp);
  /// A return of the scan begun last, relative to the sensor's mount on the floor, along the Base axes. One
  /// that is no `body` only tells that nothing stood before it.
  void add(double x_m, double y_m, bool body) {
    float& nearest = sights_.back().nearest_m[direction(x_m, y_m)];
    const float away = body ? static_cast<float>(std::sqrt(x_m * x_m + y_m * y_m)) : kNothing;
    nearest = nearest < 0.0F || away < nearest ? away : nearest;
  }
  /// Whether a thing of those heights on a square of `side_m` there would have been seen, and was not.
  [[nodiscard]] bool was_empty(const Point2<Odom>& place, double side_m, double low_m, double high_m,
                               Stamp now) const;
  /// What is remembered, oldest first, and going on with what was remembered at another time.
  [[nodiscard]] const Ring<Sight>& sights() const { return sights_; }
  void restore(Ring<Sight> sights) { sights_ = std::move(sights); }

 private:
  static constexpr int kDirections = 512;
  static constexpr float kNothing = 1e9F;
  /// The newest scan of that sensor; null where it has none.
  [[nodiscard]] const Sight* last_of(const SensorView& view) const;
  [[nodiscard]] bool shows_empty(const Sight& sight, const Point2<Odom>& place, double side_m, double low_m,
                                 double high_m) const;
  /// Diamond angle: as monotone as the angle, at the price of a division.
  [[nodiscard]] static double turn(double x_m, double y_m) {
    const double sum = std::abs(x_m) + std::abs(y_m);
    const double share = sum > 0.0 ? y_m / sum : 0.0;  // -1 to 1
    return x_m >= 0.0 ? share : 2.0 - share;           // -1 to 3
  }
  [[nodiscard]] static std::size_t direction(double x_m, double y_m) {
    return static_cast<std::size_t>((turn(x_m, y_m) + 1.0) * (kDirections / 4.0)) % kDirections;
  }

  SightOptions options_;
  Ring<Sight> sights_;
};

}  // namespace madori::planning
