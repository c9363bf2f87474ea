#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "core/odometry.hpp"
#include "core/pose_estimate.hpp"
#include "core/pose_hypothesis.hpp"
#include "localization/localizer/keyframe_motion.hpp"
#include "localization/localizer/map_state.hpp"
#include "localization/localizer/map_worker.hpp"
#include "localization/localizer/options.hpp"
#include "localization/localizer/scan_agreement.hpp"
#include "localization/localizer/scan_matcher.hpp"
#include "localization/motion_model/odometry_track.hpp"
#include "localization/scan_points.hpp"
#include "localization/surroundings/surroundings.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

/// Odometry, scans and the drawing become map_from_base, the building's metres laid rigidly on the drawing:
/// the one localizer, for logs and for driving, for 2D scans and for the wall points of a 3D lidar.
/// Deterministic: the same readings in the same order (and the same words of set_thinking) give the same
/// poses bit for bit, though the map is worked on in a thread beside. Causal: an estimate uses what was
/// handed in before it.
class Localizer {
 public:
  /// Without `initial` the place is sought on the whole drawing from what is seen (global localization).
  Localizer(const mapping::Walls& walls, const std::optional<InitialPose>& initial,
            const LocalizerOptions& options = {});

  /// Before the first scan: places of the drawing, of which bent() tells where they lie.
  void set_places(const std::vector<Point2<Map>>& drawn) {
    if (map_.drawing) map_.drawing->walls.set_places(drawn);
  }
  /// A person says that the vehicle stands there on the drawing at the newest reading, so exactly: what is
  /// seen from here on is laid there, and weighed against it.
  void set_pose(const Transform2<Map, Base>& map_from_base, const PoseSigma& sigma);
  /// Forgets the place: it is sought on the whole drawing from what is seen from here on.
  void search_anew();
  /// Where the vehicle may be on the drawing at the newest reading, likeliest first.
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const;

  /// Before the first scan: what an earlier drive remembered of this drawing. With a start pose it is used
  /// where the first scan fits into it there, and dropped otherwise; without one the place is sought by it
  /// too.
  void recall(Memory memory);
  [[nodiscard]] bool has_recalled() const { return recalled_; }

  /// Whether what is thought over beside the cycle is not finished; false where nothing is. The one thing of
  /// this class that depends on time.
  [[nodiscard]] bool is_thinking() const { return worker_.is_unfinished(); }
  /// For the scans to come: what is not finished is not waited for, however due it is. Not said: it is.
  void set_thinking(bool thinking) { thinking_ = thinking; }

  /// The pose at the reading; a reading older than its forerunner is answered but not used.
  PoseEstimate on_odometry(const OdometryReading& reading);
  /// The pose at the scan. `points` are Base frame, `sensor` is where the lidar sits.
  PoseEstimate on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor = {});

  /// How the drawing lies in the building, in which the poses are; null: as drawn.
  [[nodiscard]] std::shared_ptr<const BentDrawing> bent() const {
    return map_.drawing ? map_.drawing->walls.bent() : nullptr;
  }

  [[nodiscard]] const Memory& memory() const { return map_.memory; }
  /// What is remembered, by earlier drives too, for the next start; nothing while the place is not sure.
  [[nodiscard]] std::optional<RememberedParts> remembered() const;
  /// At the end of a log: the memory after a last thorough look at all of it. Waits for it.
  [[nodiscard]] Memory finished_memory();
  [[nodiscard]] const HealthEvidence& evidence() const { return map_.evidence; }
  [[nodiscard]] const OdometryModel& odometry_model() const { return model_; }

 private:
  [[nodiscard]] bool is_sure() const {
    return map_.placed && map_.evidence.here >= options_.health.localized;
  }
  [[nodiscard]] PoseEstimate estimate(Stamp stamp, const Transform2<Map, Base>& map_from_base) const;
  [[nodiscard]] PoseEstimate on_late_scan(Stamp stamp, const SurfaceScan& scan);
  void follow(const SurfaceScan& scan, const OdometryStep& step);
  [[nodiscard]] ScanMatch match(const SurfaceScan& scan, const OdometryStep& step) const;
  void start(const SurfaceScan& scan);
  void remember_if_new(const SurfaceScan& scan);
  void remember(const SurfaceScan& scan);
  void go_on(const MatchResult& recent, const Transform2<Map, Base>& place, const OdometryStep& step);
  void think_if_due(Stamp stamp);
  void take_in_thoughts(Stamp stamp);
  [[nodiscard]] bool was_carried(Stamp stamp, const ScanPoints& points, const OdometryStep& step,
                                 const Transform2<Map, Base>& before);
  [[nodiscard]] bool gives_up(Stamp stamp) const;
  [[nodiscard]] bool wants_another_look(Stamp stamp) const;
  void begin_anew(const std::optional<StartPrior>& told, bool carried = false);

  LocalizerOptions options_;
  std::vector<Point2<Base>> weighty_;  ///< of the scan at hand
  SurfaceScanner scanner_;
  OdometryModel model_;
  OdometryTrack track_;
  MapState map_;
  bool started_ = false;
  bool recalled_ = false;
  Stamp anchor_stamp_{};                              ///< of the last scan
  Transform2<Map, Base> anchor_;                      ///< the pose at the last scan
  std::optional<Transform2<Map, Base>> late_anchor_;  ///< of a scan whose stamp ran backwards
  Transform2<Map, Map> moved_;                        ///< the memory around the vehicle, by thinking
  OdometryStep since_scan_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Identity();
  KeyframeMotion since_keyframe_;
  ScanAgreement agreement_;
  SurroundingsCheck surroundings_;
  int keyframes_since_thinking_ = 0;
  bool thinking_ = false;  ///< as set_thinking() says
  MapWorker worker_;       ///< last: it ends first
};

}  // namespace madori::localization
