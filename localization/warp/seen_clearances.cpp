#include "localization/warp/seen_clearances.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace madori::localization {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

}  // namespace

bool is_of_one_wall(double ahead_m, double left_m, double right_m) {
  const auto [least, most] = std::minmax({ahead_m, left_m, right_m});
  return std::isfinite(most) && most - least <= kEdgeM;
}

Crossings::Crossings(double direction_rad, const MemoryCloud& about)
    : x_(std::cos(direction_rad)), y_(std::sin(direction_rad)) {
  for (const CloudSurface& surface : about) add(surface);
  for (auto& met : met_) std::sort(met.begin(), met.end());
}

void Crossings::add(const CloudSurface& s) {
  constexpr double kHalfM = 0.55 * kVoxelM;  // neighbours touch
  const auto line = [](double across_m) { return static_cast<int>(std::floor(across_m / kFineM)) + kMiddle; };
  const double dx = -s.normal_y * kHalfM, dy = s.normal_x * kHalfM;
  const double from = across(s.x_m - dx, s.y_m - dy), to = across(s.x_m + dx, s.y_m + dy);
  const double along_m = along(s.x_m, s.y_m), slope = along(dx, dy);
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  for (int k = std::max(0, line(std::min(from, to)) + 1); k <= std::min(kLines - 1, line(std::max(from, to)));
       ++k) {
    const double beside_m = (k - kMiddle) * kFineM;
    const double share = std::abs(half) > 1e-9 ? std::clamp((beside_m - middle) / half, -1.0, 1.0) : 0.0;
    met_[static_cast<std::size_t>(k)].push_back(along_m + share * slope);
  }
}

Both Crossings::nearest(double x_m, double y_m) const {
  const auto k = static_cast<std::size_t>(
      std::clamp(static_cast<int>(std::lround(across(x_m, y_m) / kFineM)) + kMiddle, 0, kLines - 1));
  const auto& met = met_[k];
  const double along_m = along(x_m, y_m);
  const auto next = std::lower_bound(met.begin(), met.end(), along_m);
  return {next != met.end() ? *next - along_m : kNone,
          next != met.begin() ? along_m - *std::prev(next) : kNone};
}

SeenClearances::SeenClearances(double direction_rad, const MemoryCloud& about)
    : ahead_(direction_rad, about),
      left_(direction_rad + kBesideRad, about),
      right_(direction_rad - kBesideRad, about) {}

Both SeenClearances::of_walls(Both ahead_m, double x_m, double y_m) const {
  const Both left_m = left_.nearest(x_m, y_m), right_m = right_.nearest(x_m, y_m);
  for (std::size_t i = 0; i < 2; ++i)
    if (!is_of_one_wall(ahead_m[i], left_m[i], right_m[i])) ahead_m[i] = kNone;
  return ahead_m;
}

}  // namespace madori::localization
