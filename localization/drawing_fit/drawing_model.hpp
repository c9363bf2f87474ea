#pragma once

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"
#include "localization/drawing_fit/wall_index.hpp"

namespace madori::localization {

/// How well the drawing describes the building, learned from the fit: a seen surface of a drawn direction
/// lies on a drawn wall with a normal error of `sigma_m`, or is something else with probability 1 -
/// `inliers`.
struct DrawingModel {
  double sigma_m = 0.2;
  double inliers = 0.5;
};

/// The mixture that the model makes of a surface's distance to its wall's line: a drawn wall with Gaussian
/// error `sigma_m`, or clutter anywhere within the reach of the wall index.
class WallMixture {
 public:
  WallMixture(const DrawingModel& model, double sigma_m) : sigma_m_(sigma_m) {
    constexpr double kClutterWidthM = 2.0 * WallIndex::kRadiusM;
    const double inliers = std::clamp(model.inliers, 0.05, 0.98);
    peak_ = inliers / (1.0 - inliers) * kClutterWidthM / (sigma_m * std::sqrt(2.0 * kPi));
  }
  /// Odds of wall against clutter, for a surface near a line of the drawing that may be none.
  [[nodiscard]] double odds(const WallIndex::Hit& hit) const {
    const double z = hit.distance_m / sigma_m_;
    return hit.probability * peak_ * std::exp(-0.5 * z * z);
  }
  /// Probability of wall, 0..1.
  [[nodiscard]] double is_wall(const WallIndex::Hit& hit) const {
    const double o = odds(hit);
    return o / (1.0 + o);
  }

 private:
  double sigma_m_;
  double peak_;
};

}  // namespace madori::localization
