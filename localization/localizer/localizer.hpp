#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/odometry.hpp"
#include "core/pose_estimate.hpp"
#include "localization/drawing_fit/drawing_fit.hpp"
#include "localization/drawing_fit/survey.hpp"
#include "localization/health/health.hpp"
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
      0.1;                    ///< a drawing more exact than this pulls on every scan, not only on the memory
  double found_nats = 8.0;    ///< nats by which the best place of all must lead to be taken for the place
  double search_walls = 8.0;  ///< that must have been seen before the first look at all places
  double move_gain = 3.0;     ///< nats by which another place must explain the memory better
  HealthLimits health;
  double lost_inliers = 0.25;  ///< a scan that fits the memory less than this leaves the pose to the wheels
};

/// The policy: odometry, scans and the drawing become map_from_base. Deterministic: the same readings in the
/// same order give the same poses bit for bit. Causal: an estimate uses what was handed in before it.
class Localizer {
 public:
  /// Without `initial` the place is sought on the whole drawing from what is seen (global localization).
  Localizer(const mapping::Walls& walls, const std::optional<InitialPose>& initial,
            const LocalizerOptions& options = {});

  /// The pose at the reading; a reading older than its forerunner is answered but not used.
  PoseEstimate on_odometry(const OdometryReading& reading);
  /// The pose at the scan. `points` are Base frame, `sensor` is where the lidar sits.
  PoseEstimate on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor = {});

  [[nodiscard]] const Memory& memory() const { return memory_; }
  [[nodiscard]] const HealthEvidence& evidence() const { return evidence_; }
  [[nodiscard]] const OdometryModel& odometry_model() const { return model_; }

 private:
  [[nodiscard]] PoseEstimate estimate(Stamp stamp, const Transform2<Map, Base>& map_from_base) const;
  MatchResult match(const SurfaceScan& scan, const OdometryStep& step) const;
  MatchResult match_from(const Transform2<Map, Base>& anchor, const SurfaceScan& scan,
                         const OdometryStep& step) const;
  void start(SurfaceScan scan);
  void remember(SurfaceScan scan, const MatchResult& match);
  [[nodiscard]] bool is_solve_due() const;
  void consult_drawing();
  bool correct_recent_drift();
  void survey_drawing(const MemoryCloud& cloud);
  void look_everywhere();
  [[nodiscard]] HealthEvidence evidence_with_time(Stamp stamp) const;
  [[nodiscard]] bool drawing_fits() const;
  void start_search();
  void note_agreement(const SurfaceScan& scan, const MatchResult& match, const OdometryStep& step);
  void update_covariance(const MatchResult& match);
  [[nodiscard]] double surprise(const Transform2<Map, Base>& first) const;

  LocalizerOptions options_;
  InitialPose initial_;
  OdometryModel model_;
  OdometryTrack track_;
  std::optional<DrawingFit> drawing_;  ///< absent: mapping without a drawing
  Memory memory_;
  Stamp anchor_stamp_{};                              ///< of the last scan
  Transform2<Map, Base> anchor_;                      ///< the pose at the last scan
  std::optional<Transform2<Map, Base>> late_anchor_;  ///< of a scan whose stamp ran backwards
  OdometryStep since_scan_;
  OdometryStep since_keyframe_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Identity();
  int keyframes_since_solve_ = 0;
  HealthEvidence evidence_;
  double next_survey_walls_ = 30.0;
  double usual_inliers_ = 0.6;   ///< share of a scan that fits the memory
  double usual_on_walls_ = 0.4;  ///< share of a scan that lies on drawn walls
  Stamp last_agreed_{};
};

}  // namespace madori::localization
