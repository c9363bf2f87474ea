#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/odometry.hpp"
#include "core/pose_estimate.hpp"
#include "localization/drawing_fit/drawing_fit.hpp"
#include "localization/memory/memory.hpp"
#include "localization/motion_model/odometry_model.hpp"
#include "localization/motion_model/odometry_track.hpp"
#include "localization/scan_points.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

/// Where the vehicle is at the start, and how sure that is.
struct InitialPose {
  Transform2<Map, Base> map_from_base;
  double sigma_m = 0.5;
  double sigma_rad = 0.17;
};

/// One configuration for every building, log and vehicle.
struct LocalizerOptions {
  SurfaceScanOptions scan;
  OdometryNoise odometry;
  MemoryOptions memory;
  double keyframe_m = 0.4;      ///< a new keyframe after this much driving
  double keyframe_rad = 0.25;   ///< or turning
  int keyframes_per_solve = 4;  ///< the graph is solved this often, and after every surprising loop
  double sure_inliers = 0.6;    ///< below it, a wider search follows
  double exact_drawing_m =
      0.1;                     ///< a drawing more exact than this pulls on every scan, not only on the memory
  double move_gain = 3.0;      ///< nats by which another place must explain the memory better
  double lost_inliers = 0.25;  ///< a scan that fits the memory less than this leaves the pose to the wheels
};

/// The policy: odometry, scans and the drawing become map_from_base. Deterministic: the same readings in the
/// same order give the same poses bit for bit. Causal: an estimate uses what was handed in before it.
class Localizer {
 public:
  Localizer(const mapping::Walls& walls, const InitialPose& initial, const LocalizerOptions& options = {});

  /// The pose at the reading; a reading older than its forerunner is answered but not used.
  PoseEstimate on_odometry(const OdometryReading& reading);
  /// The pose at the scan. `points` are Base frame, `sensor` is where the lidar sits.
  PoseEstimate on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor = {});

  [[nodiscard]] const Memory& memory() const { return memory_; }
  [[nodiscard]] const OdometryModel& odometry_model() const { return model_; }

 private:
  [[nodiscard]] PoseEstimate estimate(Stamp stamp, const Transform2<Map, Base>& map_from_base) const;
  MatchResult match(const SurfaceScan& scan, const OdometryStep& step) const;
  void start(SurfaceScan scan);
  void remember(SurfaceScan scan, const MatchResult& match);
  [[nodiscard]] bool is_solve_due() const;
  void consult_drawing();
  bool correct_recent_drift();
  [[nodiscard]] double surprise(const Transform2<Map, Base>& first) const;

  LocalizerOptions options_;
  InitialPose initial_;
  OdometryModel model_;
  OdometryTrack track_;
  std::optional<DrawingFit> drawing_;  ///< absent: mapping without a drawing
  Memory memory_;
  Stamp anchor_stamp_{};          ///< of the last scan
  Transform2<Map, Base> anchor_;  ///< the pose at the last scan
  OdometryStep since_scan_;
  OdometryStep since_keyframe_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Identity();
  int keyframes_since_solve_ = 0;
};

}  // namespace madori::localization
