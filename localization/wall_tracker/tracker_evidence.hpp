#pragma once

#include "localization/global/global_localizer.hpp"

namespace madori::localization {

/// What the last scan said.
struct TrackerEvidence {
  double explained = 0.0;      ///< share of the points on drawn walls
  double through_walls = 0.0;  ///< share of the beams that would pass a drawn wall
  double nearby_nats = 0.0;    ///< by which the best pose within 2 m fits better (coarsely)
  double kept = 1.0;           ///< share of what the scan before saw, taken from where the wheels say
  double correction_m = 0.0;   ///< between wheels and walls
  double correction_rad = 0.0;
  bool looked_elsewhere = false;
};

/// How well a scan (Base frame) suits the drawing where it was registered, and how far that is from the pose
/// that the wheels predicted; the rest as it begins.
[[nodiscard]] TrackerEvidence evidence_of(const ScanPoints& points, const RegistrationResult& fit,
                                          const Transform2<Map, Base>& predicted,
                                          const GlobalLocalizer& global);

}  // namespace madori::localization
