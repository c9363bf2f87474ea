#pragma once

#include "localization/scan_points.hpp"

namespace madori::localization {

/// The noise of the points themselves: how far each lies off the middle of its neighbours in the scan's
/// order, robustly; 0 when too few points have near neighbours to tell.
[[nodiscard]] double scan_noise_m(const ScanPoints& points);

}  // namespace madori::localization
