#pragma once

#include "localization/registration/registration_result.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

/// Share of the scan's weight on drawn walls, those beside them less: the Geman-McClure weights that
/// registration ended with.
[[nodiscard]] inline double explained(const RegistrationResult& fit, const ScanPoints& points) {
  double all = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) all += points.weight_of(i);
  return all > 0.0 ? (fit.hessian(0, 0) + fit.hessian(1, 1)) / all : 0.0;
}

}  // namespace madori::localization
