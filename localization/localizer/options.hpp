#pragma once

#include <cmath>

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/health/health.hpp"
#include "localization/memory/surface_scan.hpp"
#include "localization/motion_model/odometry_model.hpp"
#include "localization/placement/placement.hpp"

namespace madori::localization {

/// Where the vehicle is at the start, and how sure that is.
using InitialPose = StartPrior;

/// One configuration for every building, log and vehicle.
struct LocalizerOptions {
  SurfaceScanOptions scan;
  OdometryNoise odometry;
  MemoryOptions memory;
  double keyframe_m = 0.4;     ///< a new keyframe after this much driving
  double keyframe_rad = 0.25;  ///< or turning
  double sure_step_m = 0.05;   ///< wheels this exact since the last scan need no search around their word
  double sure_step_rad = 0.03;
  double sure_inliers = 0.6;  ///< below it, a wider search follows
  double exact_drawing_m =
      0.1;  ///< a drawing more exact than this pulls on every scan, not only on the memory
  double survey_growth_unsure = 1.25;  ///< all places are compared again when so many more walls were seen,
  double survey_growth = 1.5;          ///< or so many where the place is sure
  double settle_half_m = 0.4;  ///< the memory settles on the walls within this far; farther is another place
  double settle_half_rad = 0.1;
  double unconfirmed = 0.9;  ///< at most believed of a new place until more was seen there
  double tie_m = 0.3;        ///< by which the graph is held where it was placed, where nobody gave the start:
  double tie_rad = 0.1;      ///< the drawing's pulls decide
  double move_gain = 3.0;    ///< nats by which another place must explain the memory better
  double drift_walls = 6.0;  ///< that the newest stretch must have seen to be judged by itself
  double drift_agreement = 0.5;  ///< share of its scans that agree; a stretch where all do has not drifted
  double drift_share = 0.5;      ///< of the usual fit; a stretch that fits less may have drifted,
  double drift_half_m = 2.4;     ///< and is sought this far around
  double drift_half_rad = 0.3;
  double drift_least_m = 0.5;  ///< less may be the drawing's own error, and so may a smaller turn:
  double drift_least_rad = 0.1;
  double known_share = 0.8;   ///< of the usual agreement with what was remembered before: clears a doubt,
  double same_place_m = 0.3;  ///< where that puts the scan in the same place
  int restart_scans = 8;  ///< of no agreement, after which the memory is given up and the place sought anew
  double another_look_s = 3.0;  ///< a standing vehicle that does not know its place looks again
  HealthLimits health;
  double lost_inliers = 0.25;  ///< a scan that fits the memory less than this leaves the pose to the wheels
  /// What is thought over beside the cycle is taken in at the first scan this much later, by the stamps of
  /// the log and never by the clock, so that every replay gives the same poses.
  double thinking_s = 1.0;
  double first_look_s = 0.3;  ///< likewise of the first scan alone: there is little to think about,
  double young_s = 0.5;       ///< and of a memory of fewer keyframes than
  std::size_t young_size = 20;
};

/// Whether a view `moved` from the newest keyframe is a keyframe of its own.
[[nodiscard]] inline bool is_new_view(const Transform2<Base, Base>& moved, const LocalizerOptions& options) {
  return std::hypot(moved.x_m(), moved.y_m()) > options.keyframe_m ||
         std::abs(moved.yaw_rad()) > options.keyframe_rad;
}

/// For a vehicle with encoders on its driven wheels.
[[nodiscard]] inline LocalizerOptions driving_options() {
  LocalizerOptions options;
  options.odometry = driven_wheels();
  return options;
}

}  // namespace madori::localization
