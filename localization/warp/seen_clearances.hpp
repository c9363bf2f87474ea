#pragma once

#include <array>
#include <vector>

#include "core/angle.hpp"
#include "localization/drawing_fit/memory_cloud.hpp"

namespace madori::localization {

/// Both ways along an axis: ahead, behind. Metres.
using Both = std::array<double, 2>;

/// A clearance is that of one wall where beams so much beside it differ by no more; else they look past an
/// edge. The rule is the same for what is drawn and for what was seen.
inline constexpr double kBesideRad = to_rad(3.0);
inline constexpr double kEdgeM = 0.5;
[[nodiscard]] bool is_of_one_wall(double ahead_m, double left_m, double right_m);
/// Places so much beside the middle are asked about, along x and y.
inline constexpr double kPlacesReachM = 1.0;

/// Where lines along a direction, beside each other, meet what was seen about a place.
class Crossings {
 public:
  Crossings(double direction_rad, const MemoryCloud& about);
  /// From a place, metres; infinite where nothing was seen.
  [[nodiscard]] Both nearest(double x_m, double y_m) const;

 private:
  static constexpr double kFineM = 0.025;
  static constexpr int kMiddle = static_cast<int>(1.5 * kPlacesReachM / kFineM);
  static constexpr int kLines = 2 * kMiddle + 1;
  [[nodiscard]] double along(double x_m, double y_m) const { return x_ * x_m + y_ * y_m; }
  [[nodiscard]] double across(double x_m, double y_m) const { return -y_ * x_m + x_ * y_m; }
  void add(const CloudSurface& surface);

  double x_, y_;
  std::array<std::vector<double>, kLines> met_;
};

/// How far what was seen about a place is from places beside it, along one axis (`about` in metres from the
/// place, axes as drawn).
class SeenClearances {
 public:
  SeenClearances(double direction_rad, const MemoryCloud& about);
  /// Of the first surface; infinite where nothing was seen.
  [[nodiscard]] Both nearest(double x_m, double y_m) const { return ahead_.nearest(x_m, y_m); }
  /// Of what nearest() gave there, that of walls: infinite where the beam looks past an edge.
  [[nodiscard]] Both of_walls(Both ahead_m, double x_m, double y_m) const;

 private:
  Crossings ahead_, left_, right_;
};

}  // namespace madori::localization
