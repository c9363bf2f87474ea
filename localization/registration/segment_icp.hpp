#pragma once

#include "localization/registration/registration_result.hpp"
#include "localization/registration/segment_grid.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

struct SegmentIcpOptions {
  int max_iterations = 30;
  /// Scale of the Geman-McClure loss: starts wide, so that walls a metre off still pull, and shrinks by
  /// `scale_factor` an iteration down to the sensor's noise, so that furniture beside a wall lets go.
  double first_scale_m = 1.2;
  double last_scale_m = 0.06;
  double scale_factor = 0.55;
  double inlier_distance_m = 0.15;
  double min_normal_cosine = 0.7;  ///< points whose known normal differs more from the wall's are left out
  double step_limit_m = 2e-4;      ///< converged below both
  double step_limit_rad = 4e-5;
  int coarse_points = 90;  ///< while the loss is wide, about this many of the points do
  /// A pull towards the initial pose along unseen directions (bare corridor): information in counts, m^2.
  double prior_information = 1e-6;
};

/// Point-to-segment ICP: each point is drawn to the nearest drawn wall along the wall's normal, or to the end
/// of the wall beside it. Gauss-Newton on the point-to-line distance (Chen and Medioni 1992; Censi, PLICP,
/// ICRA 2008) with graduated Geman-McClure weights (Black and Rangarajan 1996).
[[nodiscard]] RegistrationResult segment_icp(const ScanPoints& points, const SegmentGrid& grid,
                                             const Transform2<Map, Base>& initial,
                                             const SegmentIcpOptions& options = {});

/// Only measures how well `points` fit at `map_from_base`: converged false, the rest filled in.
[[nodiscard]] RegistrationResult segment_fit(const ScanPoints& points, const SegmentGrid& grid,
                                             const Transform2<Map, Base>& map_from_base,
                                             const SegmentIcpOptions& options = {});

}  // namespace madori::localization
