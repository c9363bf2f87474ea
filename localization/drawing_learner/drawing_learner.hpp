#pragma once

#include <vector>

#include "core/pose_estimate.hpp"
#include "localization/scan_points.hpp"
#include "localization/self_calibration/self_calibration.hpp"
#include "localization/wall_reliability/wall_reliability.hpp"

namespace madori::localization {

/// What driving teaches of the drawing: which walls are right (WallReliability), and how the drawing is
/// stretched (self_calibrate). Looks on only: nothing that it learns changes the poses of the drive under
/// way, so that recordings replay bit for bit. Bounded memory, deterministic.
class DrawingLearner {
 public:
  explicit DrawingLearner(const mapping::Walls& walls);

  /// Is a scan wanted at this pose? Cheap; spares making the points.
  [[nodiscard]] bool is_due(const PoseEstimate& pose) const;
  /// Wall points of a scan, Base frame, and the pose at the scan's stamp; `sensor` is where the lidar sits.
  void observe(const ScanPoints& points, const Point2<Base>& sensor, const PoseEstimate& pose);

  [[nodiscard]] const WallReliability& reliability() const { return reliability_; }
  [[nodiscard]] WallReliability& reliability() { return reliability_; }
  [[nodiscard]] const std::vector<CalibrationKeyframe>& keyframes() const { return keyframes_; }
  /// The strain of the drawing from the scans kept; takes some tenths of a second.
  [[nodiscard]] SelfCalibration calibrate() const;

 private:
  [[nodiscard]] bool is_keyframe(const PoseEstimate& pose) const;
  void thin();

  mapping::Walls walls_;
  WallReliability reliability_;
  std::vector<CalibrationKeyframe> keyframes_;
  double spacing_m_ = 1.0;  ///< of driving between two scans kept for the calibration
};

}  // namespace madori::localization
