#include "localization/landmarks/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/angle.hpp"

namespace madori::localization::landmarks {
namespace {

struct Bearing {
  double angle_rad;
  double range_m;
};

double half_width(const std::vector<Bearing>& bearings) {
  constexpr double kRangeOfQuarter = 1.0823922;  // 1 / sin(67.5 degrees), in half widths
  std::vector<double> ranges;
  for (const Bearing& b : bearings) ranges.push_back(b.range_m);
  const auto quarter = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 4);
  std::nth_element(ranges.begin(), quarter, ranges.end());
  return *quarter / kRangeOfQuarter;
}

/// Gaps between neighbouring returns that are near: of at least 10 degrees, and half a corridor wide. The
/// part that a scanner does not see behind it is one of them, the way that it came.
int count_openings(std::vector<Bearing> bearings, double half_width_m) {
  constexpr double kLeastGap_rad = 10.0 / 180.0 * kPi;
  std::erase_if(bearings, [&](const Bearing& b) { return b.range_m > 3.0 * half_width_m; });
  int openings = 0;
  for (std::size_t i = 0; i < bearings.size(); ++i) {
    const Bearing& a = bearings[i];
    const Bearing& b = bearings[(i + 1) % bearings.size()];
    const double turn = b.angle_rad - a.angle_rad + (b.angle_rad < a.angle_rad ? 2.0 * kPi : 0.0);
    const double gap = std::hypot(a.range_m * std::cos(a.angle_rad) - b.range_m * std::cos(b.angle_rad),
                                  a.range_m * std::sin(a.angle_rad) - b.range_m * std::sin(b.angle_rad));
    openings += turn >= kLeastGap_rad && gap >= half_width_m ? 1 : 0;
  }
  return openings;
}

}  // namespace

Surroundings look_around(const ScanPoints& points) {
  Surroundings seen;
  if (points.empty()) return seen;
  std::vector<Bearing> bearings;
  for (std::size_t i = 0; i < points.size(); ++i)
    bearings.push_back({std::atan2(points.y_m[i], points.x_m[i]), std::hypot(points.x_m[i], points.y_m[i])});
  std::sort(bearings.begin(), bearings.end(),
            [](const Bearing& a, const Bearing& b) { return a.angle_rad < b.angle_rad; });
  const double half_m = half_width(bearings);
  seen.corridor_width_m = 2.0 * half_m;
  seen.openings = count_openings(bearings, half_m);
  const std::size_t step = (points.size() + Descriptor::kMost - 1) / Descriptor::kMost;
  for (std::size_t i = 0; i < points.size(); i += step) seen.descriptor.add(points.x_m[i], points.y_m[i]);
  return seen;
}

}  // namespace madori::localization::landmarks
