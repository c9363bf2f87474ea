#pragma once

namespace madori::localization {

/// Sizes of the memory. Lengths are metres of driving unless said otherwise.
struct MemoryOptions {
  double window_path_m = 12.0;  ///< keyframes this recent are matched against in any case
  int window_keyframes = 30;    ///< at most
  /// Of the surfaces around the vehicle that are matched against: as far as a scan reaches, and what is driven
  /// until they are gathered anew. What lies beyond would count as not agreeing.
  double map_radius_m = 32.0;
  double loop_radius_m = 3.5;   ///< how near an old keyframe must be to close a loop with it
  int loop_chain = 12;          ///< keyframes around the nearest one that make the piece to match against
  double loop_inliers = 0.55;   ///< share of the scan that must fit
  double nearby_m = 5.0;        ///< old keyframes this near count as nearby
  int nearby_keyframes = 20;    ///< at most
  double break_open_m = 60.0;   ///< a break in the chain counts as so much driving
  double drift_per_m = 0.015;   ///< growth of the uncertainty between loops, metres a metre
  double drift_rad_per_m = 0.004;
  double chain_m = 0.02;     ///< error of the motion between keyframes, metres a root-metre:
  double chain_rad = 0.006;  ///< what the match of a scan cannot know of itself
  double place_m = 0.6;      ///< keyframes this near to each other,
  double place_rad = 0.35;   ///< looking the same way, are of the same place
};

}  // namespace madori::localization
