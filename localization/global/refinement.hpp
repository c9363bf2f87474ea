#pragma once

#include <vector>

#include "localization/global/evidence.hpp"

namespace madori::localization {

/// Registers the scan from each of `poses` (base in Map) and from starts beside the likeliest answers, and
/// weighs them: by falling likelihood, none at the same place as one before. How close is close follows the
/// scan's own noise.
[[nodiscard]] std::vector<Hypothesis> refine_poses(const ScanPoints& points,
                                                   const std::vector<Transform2<Map, Base>>& poses,
                                                   const WallTables& tables);

}  // namespace madori::localization
