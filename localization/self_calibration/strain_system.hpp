#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "localization/self_calibration/self_calibration.hpp"
#include "localization/self_calibration/strain_row.hpp"

namespace madori::localization {

/// Sigmas of misdrawing beyond which a wall counts less and less (Geman-McClure).
inline constexpr double kWallLossSigmas = 2.5;

/// What one Gauss-Newton step found.
struct StrainSolution {
  bool good = false;
  Eigen::Vector3d step = Eigen::Vector3d::Zero();  ///< of the strain
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  std::vector<double> wall_offsets_m;  ///< of the walls that were seen
  double chi2_per_freedom = 1.0;
  int pieces = 0;
};

/// The least-squares problem behind self_calibrate(): its unknowns are the poses in a true-to-scale plane,
/// the strain from that plane to the drawing about the drawing's middle, and an offset a wall. The poses are
/// eliminated (Schur complement), sparse.
class StrainSystem {
 public:
  /// Begins with the drawing strained by `start`, each scan where it fits best then.
  StrainSystem(const WallIndex& drawing, const std::vector<CalibrationKeyframe>& keyframes,
               const std::vector<RelativeFactor>& motions, const CalibrationOptions& options,
               const Eigen::Vector3d& start);

  /// Associates pieces with walls, takes one step. `scale_m` is of the robust loss, `wall_sigma_m` the spread
  /// of the walls' own errors.
  StrainSolution solve(double scale_m, double wall_sigma_m);
  [[nodiscard]] const Eigen::Vector3d& strain() const { return strained_.strain; }
  /// Metres of surface that lie on the stretched drawing itself, no wall moved.
  [[nodiscard]] double explained_m(double scale_m) const;

 private:
  std::vector<StrainRow> associate(double scale_m);
  std::optional<StrainRow> row_of(const Transform2<Map, Base>& pose, const SurfacePiece& piece);
  int seen_wall(int wall);
  void take(const Eigen::VectorXd& pose_step, const Eigen::VectorXd& rest_step);

  const WallIndex& drawing_;
  const std::vector<CalibrationKeyframe>& keyframes_;
  const std::vector<RelativeFactor>& motions_;
  CalibrationOptions options_;
  StrainAbout strained_;
  std::vector<Transform2<Map, Base>> poses_;
  std::vector<Transform2<Map, Base>> first_poses_;
  std::vector<int> position_;    ///< of a wall among those seen, -1
  std::vector<double> offsets_;  ///< of the walls seen, metres
};

}  // namespace madori::localization
