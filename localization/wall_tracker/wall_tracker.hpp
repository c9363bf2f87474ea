#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/odometry.hpp"
#include "core/pose_estimate.hpp"
#include "core/pose_hypothesis.hpp"
#include "localization/global/global_localizer.hpp"
#include "localization/motion_model/odometry_track.hpp"
#include "localization/surroundings/surroundings.hpp"
#include "localization/wall_tracker/distant_rival.hpp"
#include "localization/wall_tracker/nearby_rival.hpp"
#include "localization/wall_tracker/place_search.hpp"
#include "localization/wall_tracker/pose_filter.hpp"
#include "localization/wall_tracker/scale_bank.hpp"
#include "localization/wall_tracker/tracker_evidence.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

struct WallTrackerOptions {
  SegmentIcpOptions icp = {.first_scale_m = 0.25};
  /// Of driven wheels on a hall's floor; systematic errors are learned.
  OdometryNoise odometry = driven_wheels();
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
  SurroundingsOptions surroundings;
  DistantRivalOptions distant;
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
  void search(const ScanPoints& points, const Transform2<Base, Base>& moved);
  void start_at(const RegistrationResult& found, const ScanPoints& points);
  void track(const ScanPoints& points, const OdometryStep& step, const Transform2<Map, Base>& before);
  [[nodiscard]] bool is_contradicted(const ScanPoints& points, const RegistrationResult& fit,
                                     bool has_changed);
  void correct(const RegistrationResult& fit, const OdometryStep& step);
  void place_at(const RegistrationResult& there);
  void learn_scale(const ScanPoints& seen, const OdometryStep& step);
  void miss(const std::string& reason, bool loses);
  [[nodiscard]] bool wheels_still_do() const;
  void lose(const std::string& reason, std::optional<GlobalAnswer> answer = std::nullopt);

  WallTrackerOptions options_;
  GlobalLocalizer global_;
  OdometryModel model_;
  OdometryTrack track_;
  PlaceSearch search_;
  SurroundingsCheck surroundings_;
  DistantRival distant_;
  NearbyRival nearby_;
  ScaleBank scale_;
  PoseFilter filter_;  ///< at the last scan
  bool tracking_ = false;
  int misses_ = 0;
  bool unbroken_ = false;  ///< scan followed upon scan since the last that fitted
  TrackerEvidence evidence_;
  LocalizationHealth health_{LocalizationState::Lost, "no scan yet"};
  Stamp scan_stamp_{};  ///< of the last scan
  std::optional<Transform2<Map, Base>> last_fit_;
  OdometryStep since_scan_;
};

}  // namespace madori::localization
