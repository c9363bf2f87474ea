#pragma once

#include "localization/scan_points.hpp"

namespace madori::localization {

/// The noise of the points themselves: how far each lies off the middle of its neighbours in the scan's
/// order, robustly; 0 when too few points have near neighbours to tell.
[[nodiscard]] double scan_noise_m(const ScanPoints& points);

/// The noise of a lidar by its scans so far. What stands about makes a scan look noisier than it is, so the
/// least counts.
class LidarNoise {
 public:
  /// Of a lidar after one more scan of so much noise (scan_noise_m).
  double after(double noise_m);
  [[nodiscard]] double least_m() const { return least_m_; }

 private:
  double least_m_ = 0.0;  ///< 0: not known yet
};

}  // namespace madori::localization
