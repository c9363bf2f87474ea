#pragma once

#include <optional>

#include "localization/localizer/map_state.hpp"

namespace madori::localization {

/// Where a scan lies, and where the recent keyframes alone would put it: the way between keyframes is
/// measured by these, so that finding an old place again does not enter the graph as a motion.
struct ScanMatch {
  MatchResult place;
  MatchResult recent;
};

/// Matches a scan to the memory, `step` by the wheels after the pose `from`. An exact drawing pulls along.
/// Where the recent keyframes do not explain the share `enough` of the scan, all that was remembered nearby
/// is searched, wider.
[[nodiscard]] ScanMatch match_scan(const SurfaceScan& scan, const Transform2<Map, Base>& from,
                                   const OdometryStep& step, double enough, const MapState& map,
                                   const LocalizerOptions& options);

/// Where the first scan lies in a recalled memory, near the start pose; nothing where it does not fit in.
[[nodiscard]] std::optional<Transform2<Map, Base>> place_in_memory(const SurfaceScan& scan,
                                                                   const MapState& map,
                                                                   const LocalizerOptions& options);

}  // namespace madori::localization
