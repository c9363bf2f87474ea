#pragma once

#include "core/pose_estimate.hpp"

namespace madori::localization {

/// What the localizer knows about its own right to be believed.
struct HealthEvidence {
  bool has_drawing = true;
  bool searching = false;    ///< the place is not known yet: global localization runs
  double walls_seen = 0.0;   ///< surfaces in the memory, in walls of two metres
  double fit_nats = 0.0;     ///< log likelihood of the memory on the drawing, against clutter
  bool verified = false;     ///< fit_nats were enough once to believe the start pose
  double inliers = 0.5;      ///< share of what is seen that the drawing explains
  double sigma_m = 0.2;      ///< error of the drawing as learned
  double mirrored_nats = 0;  ///< by which the mirrored drawing explains the memory better; negative: worse
  static constexpr double kNotLooked = -1e9;
  double elsewhere_nats = kNotLooked;  ///< by which the best other place explains the memory better
  double blind_m = 0.0;                ///< driven since a scan last agreed with the memory and the wheels
  double blind_s = 0.0;                ///< time since then
  int blind_scans = 0;                 ///< scans since then
  double on_walls = 0.0;               ///< share of the last scan that lies on drawn walls
  double on_memory = 0.0;              ///< share of the last scan that lies on what is remembered
  bool off_walls = false;              ///< the newest stretch lies on drawn walls much less than usual
  double position_sigma_m = 0.0;
};

/// Where the states begin. Nats are natural-log odds: 10 nats are 1 in 22 000.
struct HealthLimits {
  double verified_nats = 40.0;    ///< evidence that a start pose needs before it is believed,
  double doubted_nats = 20.0;     ///< and below which it is not believed any more
  double enough_walls = 20.0;     ///< seen before a bad fit means a wrong place
  double good_nats_a_wall = 0.6;  ///< below it: degraded
  double lost_nats_a_wall = 0.4;  ///< below it: lost
  double good_inliers = 0.28;     ///< below it: degraded
  double mirrored_nats = 15.0;
  double contradicted_nats = 12.0;  ///< another place this much better contradicts the pose
  double rival_nats = -5.0;         ///< another place this near in likelihood makes the pose ambiguous
  double blind_m = 2.0;
  double blind_s = 1.2;
  int blind_scans = 3;
  double degraded_sigma_m = 0.5;
};

/// The state and its reason in an operator's words; the gravest cause first.
[[nodiscard]] LocalizationHealth judge(const HealthEvidence& evidence, const HealthLimits& limits = {});

}  // namespace madori::localization
