#pragma once

#include <optional>

namespace madori::localization {

/// Lengths are metres of way.
struct WallFitOptions {
  double recent_m = 5.0;       ///< over which the newest scans are averaged
  double usual_m = 20.0;       ///< over which it is learned what is usual
  double slow_share = 0.3;     ///< of that, while the newest fit poorly: a poor stretch becomes usual slowly
  double way_m_per_rad = 0.3;  ///< turning shows other walls, too
  double poor_share = 0.6;     ///< of what is usual; below it the newest fit poorly
  double first_share = 0.4;    ///< usual to begin with, at least
};

/// How the scans lie on drawn walls, averaged by the way driven and not by the scan: a stretch that lies
/// beside the drawing may have drifted, whatever the lidar's rate, and a vehicle that stands before a shelf
/// has not.
class WallFit {
 public:
  explicit WallFit(const WallFitOptions& options = {}) : options_(options) {}

  /// A scan, the share of it that lies on drawn walls, after so much of driving and turning.
  void add(double on_walls, double path_m, double turned_rad);
  [[nodiscard]] double recent() const { return recent_.value_or(options_.first_share); }
  [[nodiscard]] double usual() const { return recent_ ? usual_ : options_.first_share; }
  [[nodiscard]] bool is_poor() const { return recent() < options_.poor_share * usual(); }

 private:
  WallFitOptions options_;
  std::optional<double> recent_;
  double usual_ = 0.0;
};

}  // namespace madori::localization
