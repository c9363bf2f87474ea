#pragma once

#include "core/pose_estimate.hpp"

namespace madori::localization {

/// What the localizer knows about its own right to be believed.
struct HealthEvidence {
  bool has_drawing = true;
  bool looked = false;      ///< all places of the drawing were compared since the start, or since it was lost
  double walls_seen = 0.0;  ///< surfaces in the memory, in walls of two metres
  double here = 0.0;        ///< share of the belief within 0.5 m and 10 degrees of the answer
  double around = 0.0;      ///< share within 1 m and 20 degrees of it: right, but not exactly
  double rival = 0.0;       ///< share of the belief at the likeliest other place
  double mirrored = 0.0;    ///< share of the belief that the drawing is mirrored
  double inliers = 0.5;     ///< share of what is seen that the drawing explains where it is laid
  double sigma_m = 0.2;     ///< error of the drawing as learned
  double nats_a_wall = 0.0;  ///< log likelihood of the memory on the drawing, over clutter
  double blind_m = 0.0;      ///< driven since a scan last agreed with the memory and the wheels
  double blind_s = 0.0;      ///< time since then
  int blind_scans = 0;       ///< scans since then
  double on_walls = 0.0;     ///< share of the last scan that lies on drawn walls
  double on_memory = 0.0;    ///< share of the last scan that lies on what is remembered
  bool off_walls = false;    ///< the newest stretch lies on drawn walls much less than usual
  double position_sigma_m = 0.0;
};

/// Where the states begin: shares of the belief, the same for every building.
struct HealthLimits {
  double localized = 0.95;  ///< at the answer
  double believed = 0.6;    ///< less there, and less than `localized` around: not known where
  double rival = 0.2;       ///< at another place: two places look alike
  double mirrored = 0.5;
  double explained = 0.28;  ///< of what is seen; in a wrong place, or a wrong drawing, a fifth fits by chance
  double blind_m = 2.0;
  double blind_s = 1.2;
  int blind_scans = 3;
  double degraded_sigma_m = 0.5;
};

/// The state and its reason in an operator's words; the gravest cause first.
[[nodiscard]] LocalizationHealth judge(const HealthEvidence& evidence, const HealthLimits& limits = {});

}  // namespace madori::localization
