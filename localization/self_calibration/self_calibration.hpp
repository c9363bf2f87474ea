#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/transform2.hpp"
#include "localization/drawing_fit/wall_index.hpp"
#include "localization/memory/pose_graph.hpp"
#include "localization/self_calibration/surface_pieces.hpp"

namespace madori::localization {

/// What a scan that is used for the calibration saw, and about where on the drawing.
struct CalibrationKeyframe {
  Transform2<Map, Base> map_from_base;
  std::vector<SurfacePiece> pieces;
};

struct CalibrationOptions {
  double piece_sigma_m = 0.02;  ///< of a piece's distance from its wall
  double first_scale_m = 0.5;   ///< of the robust loss on a piece, while each scan is fitted alone,
  double joint_scale_m = 0.15;  ///< when all are fitted together, narrowed round by round to
  double last_scale_m = 0.06;   ///< this
  double wall_first_m = 0.03;   ///< first guess of how far walls are misdrawn, each by itself
  double wall_most_m = 0.15;    ///< that this may grow to
  double wall_least_m = 0.005;  ///< no drawing is taken to be better
  double beside_m = 1.3;        ///< a wall farther beside than this is not the one drawn
  int rounds = 30;
  double most_strain = 0.025;  ///< of x and of y, among those tried
  double strain_step = 0.005;
  int most_starts = 3;          ///< strains that suit best, from which it is refined
  double other_strain = 0.003;  ///< results farther apart speak of different sizes of the building
  double rival_share = 0.95;    ///< of the surface explained, with which another size is as good
};

/// How the drawing is stretched against the building: drawn = (I + strain) * true, after a rigid motion, with
/// strain = [x, shear / 2; shear / 2, y]. Positive x: the drawing is too large along x.
struct SelfCalibration {
  Eigen::Vector3d strain = Eigen::Vector3d::Zero();  ///< x, y, shear (rad)
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  double wall_sigma_m = 0.0;  ///< how far walls are misdrawn besides, each by itself
  int walls = 0;              ///< that were seen
  int displaced = 0;          ///< of these, walls that were left out as drawn elsewhere
  int keyframes = 0;
  int pieces = 0;
  bool converged = false;  ///< and no other strain suits about as well

  /// The same scale along x and y and no shear, as well as these figures know it.
  [[nodiscard]] double uniform() const;
  [[nodiscard]] double uniform_sigma() const;
  /// Squared Mahalanobis distance of the strain from a uniform one (2 degrees of freedom): above 9.2 the
  /// stretch or the shear is significant at 1 %.
  [[nodiscard]] double stretch_chi2() const;
};

/// Strain of the drawing, jointly with the pose of every keyframe and with how far each wall is misdrawn, by
/// robust least squares (Gauss-Newton, graduated Geman-McClure; a wall's own error is a random effect whose
/// spread is estimated too). Strains are searched first, since from a wrong one walls a little beside each
/// other are taken for one another; of those that suit, the one whose drawing explains the greatest length of
/// surfaces counts. The lidar's metre is the truth: without `motions` only what one scan saw at once tells
/// lengths. `motions` between keyframes (measured by scan matching) tie them together, so that lengths that
/// no single scan sees are told as well. An unknown direction keeps the prior of 5 %.
[[nodiscard]] SelfCalibration self_calibrate(const WallIndex& drawing,
                                             const std::vector<CalibrationKeyframe>& keyframes,
                                             const std::vector<RelativeFactor>& motions = {},
                                             const CalibrationOptions& options = {});

}  // namespace madori::localization
