#pragma once

#include <Eigen/Core>
#include <optional>

#include "app/cycle/pose_source.hpp"
#include "localization/global/global_localizer.hpp"
#include "localization/wall_extraction/wall_extraction.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::app {

struct DrawingPoseOptions {
  localization::CloudWallOptions walls;
  localization::SegmentIcpOptions icp = {.first_scale_m = 0.25};
  double sure_inliers =
      0.35;  ///< share of the wall points on drawn walls, below which a scan teaches nothing
  double most_correction_m = 0.4;  ///< a scan that asks for more is not believed
  double most_correction_rad = 0.15;
  int sightings_to_start = 2;  ///< answers in a row that agree before the vehicle counts as localized
  int misses_to_degrade = 4;   ///< scans in a row that teach nothing
  int misses_to_lose = 14;
  double odometry_m_per_m = 0.03;  ///< one sigma of the wheels, by the way driven
  double odometry_rad_per_rad = 0.03;
  double odometry_rad_per_m = 0.01;
  double scan_sigma_m = 0.01;  ///< no registration is believed to be better than this
  double scan_sigma_rad = 0.002;
};

/// The pose of a vehicle with a 3D lidar on the drawing: global localization while it does not know where it
/// is, then registration of each revolution's walls to the drawn ones, weighed against the wheels (extended
/// Kalman filter). Lost within misses_to_lose revolutions, and global again from there.
class DrawingPose final : public PoseSource {
 public:
  explicit DrawingPose(const mapping::Walls& walls, const DrawingPoseOptions& options = {});

  PoseEstimate on_odometry(const OdometryReading& reading) override;
  void on_cloud(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& odom_from_base) override;
  void set_pose(const Transform2<Map, Base>& map_from_base, const PoseSigma& sigma) override;
  void search_anew() override;
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const override;

 private:
  void check_given(const localization::ScanPoints& points, const Transform2<Base, Base>& moved);
  void start_at(const localization::RegistrationResult& fit);
  void search(const localization::ScanPoints& points, const Transform2<Base, Base>& moved);
  void track(const localization::ScanPoints& points, const Transform2<Base, Base>& moved);
  void correct(const localization::RegistrationResult& fit, const Transform2<Map, Base>& predicted);
  void miss(const std::string& reason);

  DrawingPoseOptions options_;
  localization::GlobalLocalizer global_;
  std::optional<localization::GlobalAnswer> answer_;  ///< of the search under way
  std::optional<PoseSigma> given_;                    ///< anchor_ is what a person said, not yet checked
  int agreeing_ = 0;
  bool tracking_ = false;
  int misses_ = 0;
  double explained_ = 0.0;  ///< share of the last revolution's points on walls
  LocalizationHealth health_{LocalizationState::Lost, "no scan yet"};
  Transform2<Odom, Base> odom_;  ///< newest
  Transform2<Odom, Base> anchor_odom_;
  Transform2<Map, Base> anchor_;  ///< the pose at the last revolution
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Identity();
};

}  // namespace madori::app
