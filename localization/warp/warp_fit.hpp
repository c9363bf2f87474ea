#pragma once

#include <array>
#include <functional>
#include <vector>

#include "localization/drawing_fit/memory_cloud.hpp"
#include "localization/drawing_fit/wall_index.hpp"
#include "localization/warp/drawing_warp.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

/// What was seen of a drawn wall from one of its sides. The wall stands `offset_m` beside where the warp
/// carries it, along its normal (positive to the left of a -> b).
struct WallSide {
  double offset_m = 0.0;
  double sigma_m = 0.0;  ///< of the offset; of a wall not seen, what such walls are off by
  double seen_m = 0.0;   ///< length of surface that belongs to it
  double inliers = 0.0;  ///< share of the drawn length, where looked at, that has such a surface, 0..1
};

/// Of one drawn wall: seen from its left, and from its right, where the normal is the left one.
struct WallDeviation {
  std::array<WallSide, 2> sides;

  /// Both sides together, by what was seen.
  [[nodiscard]] double offset_m() const;
  [[nodiscard]] double seen_m() const { return sides[0].seen_m + sides[1].seen_m; }
};

/// Another explanation of the same memory.
struct OtherWay {
  DrawingWarp warp;
  double odds = 0.0;  ///< against the one that was taken, 0..1
};

struct WarpFit {
  DrawingWarp warp;
  DrawingWarp next;  ///< where the next fit begins: the likeliest field, also where it is not believed
  std::vector<WallDeviation> walls;  ///< one a drawn wall, in their order
  double residual_m = 0.0;           ///< error of the drawing after the warp: walls and their pieces together
  double evidence_nats = 0.0;        ///< for a warp against the drawing as it is; below zero it is identity
  double walls_seen = 0.0;           ///< walls of two metres that the fit rests on
  std::vector<OtherWay> others;      ///< what further starts led to
};

/// What is known of a warp beside what was seen, as the log of a probability but for a constant.
using WarpPrior = std::function<double(const DrawingWarp&)>;

/// Where the drawn walls really stand, from the surfaces of a memory in the Building frame (typed Map until
/// the memory is). Least squares over the normal distances of surfaces from the warped walls, each side of a
/// wall with an offset of its own (a random effect, Student's t), with a Gaussian field of Matern covariance
/// as the prior of the displacement (Lindgren, Rue, Lindstroem 2011, eq. (2): a sparse precision); surfaces
/// are drawn walls or clutter (a mixture). Amplitudes are learned by empirical Bayes; the warp is identity
/// unless the marginal likelihood says otherwise. `before` is where the association starts: call it as the
/// memory grows, each time with WarpFit::next of the fit before. Least squares end at the nearest optimum:
/// `further` starts, in which some of the walls are taken for their neighbours, end elsewhere, and the
/// likeliest end is taken. `told` weighs the ends, too.
[[nodiscard]] WarpFit fit_warp(const WallIndex& drawn, const MemoryCloud& cloud, const DrawingWarp& before,
                               const std::vector<DrawingWarp>& further = {}, const WarpPrior& told = {});

/// The same for a memory that was not followed while it grew: its keyframes a few at a time, as driven.
[[nodiscard]] WarpFit fit_warp_from_start(const WallIndex& drawn, const MemoryCloud& cloud);

/// Drawn walls where they stand, for registration: Building metres (typed Map until registration is), ids of
/// the drawn ones. Carried over by the warp and their offsets, in pieces of at most 2 m where it bends them.
/// A wall drawn as one line that was seen from both sides becomes the two faces seen.
[[nodiscard]] mapping::Walls walls_in_building(const mapping::Walls& drawn, const WarpFit& fit);

}  // namespace madori::localization
