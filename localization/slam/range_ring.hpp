#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/angle.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

/// The shortest range of a scan in each of 720 directions from the sensor; infinite where nothing was seen.
class RangeRing {
 public:
  static constexpr std::size_t kSize = 720;

  RangeRing(const ScanPoints& scan, const Point2<Base>& sensor) : sensor_(sensor) {
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const double dx = scan.x_m[i] - sensor.x_m;
      const double dy = scan.y_m[i] - sensor.y_m;
      double& r = ranges_[index(std::atan2(dy, dx))];
      r = std::min(r, std::hypot(dx, dy));
    }
  }
  [[nodiscard]] static std::size_t index(double bearing_rad) {
    const double turn = bearing_rad / (2.0 * kPi) + 0.5;
    return std::min(static_cast<std::size_t>(std::max(0.0, turn) * kSize), kSize - 1);
  }
  /// Of the beams beside this direction the one that ends first; 0 where they do not all end somewhere.
  [[nodiscard]] double free_m(std::size_t at) const {
    double least = 1e9;
    int seen = 0;
    for (std::size_t k = kSize - kBeside; k <= kSize + kBeside; ++k) {
      const double r = ranges_[(at + k) % kSize];
      if (!std::isfinite(r)) continue;
      least = std::min(least, r);
      ++seen;
    }
    return seen >= 2 ? least : 0.0;
  }
  /// Whether beams end behind `p` by more than the margin, which grows with the distance: the heading errs,
  /// and walls are slanted. Says in which direction.
  [[nodiscard]] bool passes(const Point2<Base>& p, double margin_m, std::size_t& direction) const {
    constexpr double kMarginPerM = 0.03;
    const double dx = p.x_m - sensor_.x_m;
    const double dy = p.y_m - sensor_.y_m;
    const double range = std::hypot(dx, dy);
    direction = index(std::atan2(dy, dx));
    return range + margin_m + kMarginPerM * range < free_m(direction);
  }

 private:
  static constexpr std::size_t kBeside = 2;
  Point2<Base> sensor_;
  std::vector<double> ranges_ = std::vector<double>(kSize, INFINITY);
};

}  // namespace madori::localization
