#include "localization/global/scan_noise.hpp"

#include <cmath>
#include <vector>

#include "core/median.hpp"

namespace madori::localization {

double scan_noise_m(const ScanPoints& points) {
  constexpr double kNear = 1.0;
  constexpr std::size_t kLeast = 30;
  constexpr double kMedianOfRayleigh = 1.1774;
  std::vector<double> off;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Point2<Base> before = points.point(i - 1);
    const Point2<Base> after = points.point(i + 1);
    if (distance_m(before, after) > kNear) continue;
    off.push_back(distance_m(points.point(i),
                             Point2<Base>{0.5 * (before.x_m + after.x_m), 0.5 * (before.y_m + after.y_m)}));
  }
  if (off.size() < kLeast) return 0.0;
  return median_of(off) / (kMedianOfRayleigh * std::sqrt(1.5));
}

double LidarNoise::after(double noise_m) {
  if (noise_m > 0.0 && (least_m_ == 0.0 || noise_m < least_m_)) least_m_ = noise_m;
  return least_m_;
}

}  // namespace madori::localization
