#pragma once

#include <optional>

namespace madori::localization {

/// How the scans lie on drawn walls, averaged by the way driven and not by the scan: a stretch that lies
/// beside the drawing may have drifted, whatever the lidar's rate, and a vehicle that stands before a shelf
/// has not.
class WallFit {
 public:
  /// A scan, the share of it that lies on drawn walls, after so much of driving and turning.
  void add(double on_walls, double path_m, double turned_rad);
  [[nodiscard]] double recent() const { return recent_.value_or(kFirstShare); }
  [[nodiscard]] double usual() const { return recent_ ? usual_ : kFirstShare; }
  [[nodiscard]] bool is_poor() const { return recent() < kPoorShare * usual(); }

 private:
  static constexpr double kPoorShare = 0.6;   ///< of what is usual; below it the newest fit poorly
  static constexpr double kFirstShare = 0.4;  ///< usual to begin with, at least

  std::optional<double> recent_;
  double usual_ = 0.0;
};

}  // namespace madori::localization
