#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/odometry.hpp"
#include "core/pose_estimate.hpp"
#include "core/pose_hypothesis.hpp"
#include "localization/global/global_localizer.hpp"
#include "localization/motion_model/odometry_track.hpp"
#include "localization/wall_tracker/nearby_rival.hpp"
#include "localization/wall_tracker/recent_view.hpp"
#include "localization/wall_tracker/scale_bank.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

struct WallTrackerOptions {
  SegmentIcpOptions icp = {.first_scale_m = 0.25};
  /// Of driven wheels on a hall's floor; systematic errors are learned.
  OdometryNoise odometry = {.distance_per_m = 0.01,
                            .sideways_per_m = 0.005,
                            .heading_per_m = 0.005,
                            .heading_per_rad = 0.02,
                            .standing_m = 0.001,
                            .standing_rad = 0.0005,
                            .prior_distance_scale = 0.02,
                            .prior_heading_per_m = 0.02,
                            .prior_heading_scale = 0.03};
  double scan_sigma_m = 0.006;  ///< error of a registration that neighbouring scans share
  double scan_sigma_rad = 0.0008;
  double sure_inliers = 0.35;      ///< share of the wall points on drawn walls, below which a scan is no help
  double most_correction_m = 0.4;  ///< a scan that asks for more speaks of another place
  double most_correction_rad = 0.15;
  int sightings_to_start = 2;  ///< answers in a row that agree before the vehicle counts as localized
  int misses_to_degrade = 4;   ///< scans in a row that teach nothing
  int misses_to_lose = 12;
  /// As long as each scan agrees with the one before, the wheels carry the vehicle past what is not drawn
  /// until they may have erred by so much.
  double wheels_alone_m = 0.3;
  double wheels_alone_rad = 0.1;
  double doubt_fall = 0.10;     ///< of the explained share below the usual: other places are looked at
  double doubt_through = 0.10;  ///< rise of the share of beams through drawn walls: likewise
  double doubt_nats = 4.0;      ///< by which a pose within 2 m may fit better before: likewise
  double rival_nats = 5.0;      ///< by which another place must fit better to contradict the pose
  int rivals_to_lose = 2;       ///< contradictions in a row
  /// After so many scans and metres that fitted, with no sign that the vehicle was carried, it is where it is
  /// said to be: among racks another place may fit by chance, as long as the vehicle stands there. More is
  /// needed then, from that many places so far apart.
  int scans_to_settle = 50;
  double metres_to_settle = 2.0;
  double settled_nats = 15.0;
  int settled_rivals = 10;
  double settled_every_m = 0.3;
  int calm_scans = 2;  ///< after the other places were looked at in vain
  /// What two scans in a row both see falls by so much below the usual where the later one was taken
  /// elsewhere: neither driving nor what moves about changes a quarter of the walls in a tenth of a second.
  double carried_fall = 0.25;
  double changed_fall = 0.08;    ///< where a place that looks alike may be where it was carried to
  double changed_spreads = 8.0;  ///< at least, in mean deviations
  double twin_nats = 12.0;       ///< by which a place may fit worse to look alike
};

/// What the last scan said.
struct TrackerEvidence {
  double explained = 0.0;      ///< share of the points on drawn walls
  double through_walls = 0.0;  ///< share of the beams that would pass a drawn wall
  double nearby_nats = 0.0;    ///< by which the best pose within 2 m fits better (coarsely)
  double kept = 1.0;           ///< share of what the scan before saw, taken from where the wheels say
  double correction_m = 0.0;   ///< between wheels and walls
  double correction_rad = 0.0;
  bool looked_elsewhere = false;
};

/// The pose on a drawing that is right: global localization while the place is not known, then registration
/// of each scan's walls to the drawn ones, weighed against the wheels (extended Kalman filter; the wheels'
/// systematic errors are learned). Each scan is also asked whether another place would suit it better, and
/// whether it was taken near the one before. For VLP-16 clouds after wall extraction and for 2D scans.
/// Deterministic, causal.
class WallTracker {
 public:
  explicit WallTracker(const mapping::Walls& walls, const WallTrackerOptions& options = {});

  /// The pose at the reading; a reading older than its forerunner is answered but not used.
  PoseEstimate on_odometry(const OdometryReading& reading);
  /// The pose at the scan: points on walls, Base frame at `stamp`.
  PoseEstimate on_scan(Stamp stamp, const ScanPoints& seen);
  /// A person says that the vehicle stands about there at the newest reading of the wheels; checked by the
  /// next scan.
  void set_pose(const Transform2<Map, Base>& map_from_base, const PoseSigma& sigma);
  /// Forgets the pose.
  void search_anew();

  /// Where the vehicle may be at the newest reading, likeliest first.
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const;
  [[nodiscard]] const TrackerEvidence& evidence() const { return evidence_; }
  [[nodiscard]] const OdometryModel& odometry_model() const { return model_; }
  [[nodiscard]] const ScaleBank& scale() const { return scale_; }

 private:
  [[nodiscard]] PoseEstimate estimate(Stamp stamp) const;
  void check_given(const ScanPoints& points);
  void search(const ScanPoints& points, const Transform2<Base, Base>& moved);
  void start_at(const RegistrationResult& found, const ScanPoints& points);
  void track(const ScanPoints& points, const OdometryStep& step);
  [[nodiscard]] double fall_of_view(const Transform2<Base, Base>& by_wheels,
                                    const Transform2<Base, Base>& by_walls);
  [[nodiscard]] bool is_doubtful() const;
  [[nodiscard]] bool is_settled() const;
  [[nodiscard]] bool is_contradicted(const ScanPoints& points, const RegistrationResult& fit,
                                     bool has_changed);
  void correct(const RegistrationResult& fit, const OdometryStep& step);
  void place_at(const RegistrationResult& there);
  void learn_scale(const ScanPoints& seen, const OdometryStep& step);
  void miss(const std::string& reason, bool loses);
  [[nodiscard]] bool wheels_still_do() const;
  void lose(const std::string& reason, std::optional<GlobalAnswer> answer);

  WallTrackerOptions options_;
  GlobalLocalizer global_;
  OdometryModel model_;
  ScaleBank scale_;
  NearbyRival nearby_;
  OdometryTrack track_;
  std::optional<GlobalAnswer> answer_;  ///< of the search under way
  std::optional<PoseSigma> given_;      ///< anchor_ is what a person said, not yet checked
  int agreeing_ = 0;
  bool tracking_ = false;
  int misses_ = 0;
  bool unbroken_ = false;  ///< scan followed upon scan since the last that fitted
  int rivals_ = 0;
  int settled_ = 0;             ///< scans that fitted since the vehicle may last have been carried,
  double settled_m_ = 0.0;      ///< and metres driven with them
  double since_rival_m_ = 0.0;  ///< metres driven since other places were last looked at
  int calm_ = 0;
  double usual_explained_ = 0.0;
  double usual_through_ = 0.0;
  RecentView view_;
  TrackerEvidence evidence_;
  LocalizationHealth health_{LocalizationState::Lost, "no scan yet"};
  Stamp anchor_stamp_{};
  Transform2<Map, Base> anchor_;  ///< the pose at the last scan
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Identity() * 1e4;
  std::optional<Transform2<Map, Base>> last_fit_;
  OdometryStep since_scan_;
};

}  // namespace madori::localization
