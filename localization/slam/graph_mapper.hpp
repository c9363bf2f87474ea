#pragma once

#include <map>
#include <memory>
#include <vector>

#include "localization/global/scan_noise.hpp"
#include "localization/localizer/map_state.hpp"
#include "localization/localizer/options.hpp"
#include "localization/slam/joints.hpp"
#include "localization/slam/laid_way.hpp"
#include "localization/slam/loop_finder.hpp"
#include "localization/slam/mapper.hpp"
#include "localization/slam/scan_follower.hpp"

namespace madori::localization {

/// Pose graph of keyframes: each scan is matched to the recent ones, loops are closed as they are driven, and
/// at the end every keyframe is matched once more to all those that saw the same surfaces.
///
/// A vehicle that was carried away starts a piece of its own; pieces are tied when places are found again by
/// what they look like. What is never tied to the largest piece is no part of the map.
class GraphMapper final : public Mapper {
 public:
  explicit GraphMapper(const LocalizerOptions& options = {});

  PoseEstimate on_odometry(const OdometryReading& reading) override;
  PoseEstimate on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor) override;
  /// May also be asked on the way: the mapper goes on afterwards as if it had not been.
  [[nodiscard]] FinishedMap finish() override;
  /// What was seen so far, and where from.
  [[nodiscard]] const Memory& memory() const { return map_.memory; }
  /// The same where answers are given: a piece that nothing ties lies where the wheels led.
  [[nodiscard]] Memory shown() const;
  /// Whether the newest keyframe lies on what those before keyframe `end` saw: the drive is tied to them.
  /// After a cut: whether it is of the largest piece.
  [[nodiscard]] bool lies_on_earlier(std::size_t end) const;

 private:
  [[nodiscard]] PoseEstimate estimate(Stamp stamp) const;
  [[nodiscard]] FinishedMap finished();
  void follow(const SurfaceScan& scan);
  void remember(const SurfaceScan& scan);
  void judge_joints(std::size_t until);
  void lead_otherwise(std::size_t first, const RelativeFactor& motion);
  void cut(std::size_t first);
  void close_loops(bool at_end);
  void tie(const std::vector<RelativeFactor>& loops);
  void note_piece();
  [[nodiscard]] bool sees_through_newest(const SurfaceScan& scan) const;
  void untie_what_is_doubtful();
  [[nodiscard]] int keep_largest_piece();
  [[nodiscard]] std::vector<MomentPose> laid_pieces(const Memory& memory) const;

  LocalizerOptions options_;
  ScanFollower follower_;
  MapState map_;  ///< without a drawing
  LidarNoise noise_;
  Transform2<Map, Base> anchor_;  ///< the pose at the last scan
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  LocalizationState state_ = LocalizationState::Localized;
  std::vector<ReckonedPose> reckoned_;  ///< one a scan, by the scans' own motions: no loop moves it
  std::vector<std::shared_ptr<const SurfaceScan>> scans_;  ///< all, for the last look
  std::vector<std::size_t> scan_of_;                       ///< the scan that each keyframe is
  JointOptions joints_;
  double off_wheels_ = 0.0;  ///< sigmas squared that scans led off the wheels, since the newest keyframe
  std::vector<double> off_wheels_at_;    ///< on the way to each keyframe
  std::vector<OdometryStep> wheels_at_;  ///< the wheels' word of that way
  LoopFinder finder_;
  int cuts_ = 0;
  std::size_t judged_ = 1;  ///< joints before this keyframe
  /// Pieces that nothing ties lie far apart in the memory, by their first keyframes; answers are given where
  /// the wheels led.
  std::map<std::size_t, Transform2<Map, Map>> shown_from_piece_;
  Transform2<Map, Map> shown_from_memory_;
  bool is_apart_ = false;  ///< the vehicle is in another piece than the largest
};

}  // namespace madori::localization
