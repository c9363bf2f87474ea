#pragma once

#include <memory>
#include <vector>

#include "localization/localizer/keyframe_motion.hpp"
#include "localization/localizer/map_state.hpp"
#include "localization/localizer/options.hpp"
#include "localization/motion_model/odometry_track.hpp"
#include "localization/slam/laid_way.hpp"
#include "localization/slam/mapper.hpp"

namespace madori::localization {

/// Pose graph of keyframes: each scan is matched to the recent ones, loops are closed as they are driven, and
/// at the end every keyframe is matched once more to all those that saw the same surfaces.
class GraphMapper final : public Mapper {
 public:
  explicit GraphMapper(const LocalizerOptions& options = {});

  PoseEstimate on_odometry(const OdometryReading& reading) override;
  PoseEstimate on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor) override;
  /// May also be asked on the way: the mapper goes on afterwards as if it had not been.
  [[nodiscard]] FinishedMap finish() override;
  /// What was seen so far, and where from.
  [[nodiscard]] const Memory& memory() const { return map_.memory; }
  /// Whether the newest keyframe lies on what those before keyframe `end` saw: the drive is tied to them.
  [[nodiscard]] bool lies_on_earlier(std::size_t end) const;

 private:
  [[nodiscard]] PoseEstimate estimate(Stamp stamp) const;
  void follow(const SurfaceScan& scan, const OdometryStep& step);
  void remember(const SurfaceScan& scan);
  void close_loops();

  LocalizerOptions options_;
  OdometryModel model_;
  OdometryTrack track_;
  MapState map_;  ///< without a drawing
  Stamp anchor_stamp_{};
  Transform2<Map, Base> anchor_;  ///< the pose at the last scan
  OdometryStep since_scan_;
  KeyframeMotion since_keyframe_;
  double usual_inliers_ = 0.6;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  LocalizationState state_ = LocalizationState::Localized;
  std::vector<ReckonedPose> reckoned_;  ///< one a scan, by the scans' own motions: no loop moves it
  std::vector<std::shared_ptr<const SurfaceScan>> scans_;  ///< all, for the last look
  std::vector<std::size_t> scan_of_;                       ///< the scan that each keyframe is
};

}  // namespace madori::localization
