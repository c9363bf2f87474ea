#pragma once

#include "localization/registration/point_map.hpp"
#include "localization/registration/registration_result.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

struct CpdOptions {
  int max_iterations = 60;
  double outliers = 0.3;        ///< w: share of the scan's points that the map does not explain
  std::size_t most_scan = 180;  ///< both sets are thinned to so many points: the cost is their product
  std::size_t most_map = 500;
  double reach_m = 1.5;         ///< only the map's points this near to the scan as placed take part
  double sigma_limit_m = 1e-3;  ///< converged when sigma is below, or changes by less than a ten-thousandth
};

/// Rigid coherent point drift (Myronenko and Song, PAMI 32, 2010, figure 2), without scaling: the map's
/// points near the scan are the centroids of a Gaussian mixture, the scan's points the data. The scan sees
/// only a part of the map, and this way round only the scan has to be explained. (That the scan moves and not
/// the centroids is the same.)
[[nodiscard]] RegistrationResult cpd(const ScanPoints& points, const PointMap& map,
                                     const Transform2<Map, Base>& initial, const CpdOptions& options = {});

}  // namespace madori::localization
