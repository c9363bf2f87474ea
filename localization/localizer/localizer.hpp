#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/odometry.hpp"
#include "core/pose_estimate.hpp"
#include "localization/health/wall_fit.hpp"
#include "localization/localizer/map_state.hpp"
#include "localization/localizer/map_worker.hpp"
#include "localization/localizer/options.hpp"
#include "localization/motion_model/odometry_track.hpp"
#include "localization/scan_points.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

/// The policy: odometry, scans and the drawing become map_from_base. Deterministic: the same readings in the
/// same order give the same poses bit for bit, though the map is thought over in a thread beside. Causal: an
/// estimate uses what was handed in before it.
class Localizer {
 public:
  /// Without `initial` the place is sought on the whole drawing from what is seen (global localization).
  Localizer(const mapping::Walls& walls, const std::optional<InitialPose>& initial,
            const LocalizerOptions& options = {});

  /// Before the first scan: what an earlier drive remembered of this drawing. It is used where the first scan
  /// fits into it near the start pose, and dropped otherwise.
  void recall(Memory memory);
  [[nodiscard]] bool has_recalled() const { return recalled_; }

  /// The pose at the reading; a reading older than its forerunner is answered but not used.
  PoseEstimate on_odometry(const OdometryReading& reading);
  /// The pose at the scan. `points` are Base frame, `sensor` is where the lidar sits.
  PoseEstimate on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor = {});

  [[nodiscard]] const Memory& memory() const { return map_.memory; }
  /// At the end of a log: the memory after a last thorough look at all of it. Waits for it.
  [[nodiscard]] Memory finished_memory();
  [[nodiscard]] const HealthEvidence& evidence() const { return map_.evidence; }
  [[nodiscard]] const OdometryModel& odometry_model() const { return model_; }

 private:
  [[nodiscard]] PoseEstimate estimate(Stamp stamp, const Transform2<Map, Base>& map_from_base) const;
  /// Where the scan lies, and where the recent keyframes alone would put it: the way between keyframes is
  /// measured by these, so that finding an old place again does not enter the graph as a motion.
  struct Match {
    MatchResult place;
    MatchResult recent;
  };
  Match match(const SurfaceScan& scan, const OdometryStep& step) const;
  Match match_from(const Transform2<Map, Base>& anchor, const SurfaceScan& scan,
                   const OdometryStep& step) const;
  void start(SurfaceScan scan);
  [[nodiscard]] std::optional<Transform2<Map, Base>> place_in_memory(const SurfaceScan& scan) const;
  void remember(SurfaceScan scan);
  void go_on(const MatchResult& recent, const OdometryStep& step);
  void think_if_due(Stamp stamp);
  void take_in_thoughts(Stamp stamp);
  [[nodiscard]] HealthEvidence evidence_with_time(Stamp stamp) const;
  [[nodiscard]] bool drawing_is_exact() const;
  void search_from_here(SurfaceScan scan);
  [[nodiscard]] bool jumps(const MatchResult& match, const OdometryStep& step) const;
  [[nodiscard]] bool is_known_from_before(const SurfaceScan& scan, const MatchResult& match) const;
  void note_agreement(const SurfaceScan& scan, const MatchResult& match, const OdometryStep& step);
  void update_covariance(const MatchResult& match);

  LocalizerOptions options_;
  OdometryModel model_;
  OdometryTrack track_;
  MapState map_;
  bool started_ = false;
  bool recalled_ = false;
  Stamp anchor_stamp_{};                              ///< of the last scan
  Transform2<Map, Base> anchor_;                      ///< the pose at the last scan
  std::optional<Transform2<Map, Base>> late_anchor_;  ///< of a scan whose stamp ran backwards
  OdometryStep since_scan_;
  OdometryStep since_keyframe_;   ///< by the wheels
  Transform2<Base, Base> moved_;  ///< since the newest keyframe, by the recent ones
  double moved_agreement_ = 1.0;  ///< the least of the scans since then with the recent ones
  Eigen::Matrix3d moved_information_ = Eigen::Matrix3d::Zero();  ///< of the last of these matches, Map axes
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Identity();
  int keyframes_since_thinking_ = 0;
  double usual_inliers_ = 0.6;  ///< share of a scan that fits the memory
  WallFit wall_fit_;
  bool beside_walls_ = false;  ///< the last scan: think at once, the newest stretch may have drifted
  Stamp last_agreed_{};
  double doubt_path_m_ = 0.0;  ///< driven when the last scan agreed; newer keyframes agree with themselves
  MapWorker worker_;           ///< last: it ends first
};

}  // namespace madori::localization
