#include "app/pose/drawing_pose.hpp"

#include <Eigen/LU>
#include <cmath>

#include "core/angle.hpp"

namespace madori::app {
namespace {

constexpr double kSamePlaceM = 0.3;
constexpr double kSamePlaceRad = 0.1;

bool is_same_place(const Transform2<Map, Base>& a, const Transform2<Map, Base>& b) {
  return distance_m(a.translation(), b.translation()) < kSamePlaceM &&
         std::abs(wrap_angle(a.yaw_rad() - b.yaw_rad())) < kSamePlaceRad;
}

/// What the wheels add to the uncertainty while the vehicle moves by `moved`, Map frame.
Eigen::Matrix3d grown(const Eigen::Matrix3d& covariance, const Transform2<Base, Base>& moved,
                      const Transform2<Map, Base>& from, const DrawingPoseOptions& o) {
  const double way_m = std::hypot(moved.x_m(), moved.y_m());
  const double turn_rad = std::abs(moved.yaw_rad());
  const double sigma_m = o.odometry_m_per_m * way_m + 1e-4;
  const double sigma_rad = o.odometry_rad_per_m * way_m + o.odometry_rad_per_rad * turn_rad + 1e-5;
  const Point2<Map> ahead = from * Point2<Base>{moved.x_m(), moved.y_m()};
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Identity();
  jacobian(0, 2) = -(ahead.y_m - from.y_m());
  jacobian(1, 2) = ahead.x_m - from.x_m();
  const Eigen::Vector3d noise(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad);
  return jacobian * covariance * jacobian.transpose() + Eigen::Matrix3d(noise.asDiagonal());
}

}  // namespace

DrawingPose::DrawingPose(const mapping::Walls& walls, const DrawingPoseOptions& options)
    : options_(options), global_(walls) {}

PoseEstimate DrawingPose::on_odometry(const OdometryReading& reading) {
  const auto moved = anchor_odom_.inverse() * reading.odom_from_base;
  return {reading.stamp, anchor_ * moved, grown(covariance_, moved, anchor_, options_), health_};
}

void DrawingPose::on_cloud(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& odom_from_base) {
  const auto points = localization::extract_walls(cloud, options_.walls);
  const auto moved = anchor_odom_.inverse() * odom_from_base;
  anchor_odom_ = odom_from_base;
  if (tracking_)
    track(points, moved);
  else
    search(points, moved);
}

void DrawingPose::search(const localization::ScanPoints& points, const Transform2<Base, Base>& moved) {
  using localization::GlobalState;
  auto answer = answer_ ? global_.locate(points, *answer_, moved) : global_.locate(points);
  const bool found = answer.state == GlobalState::Found;
  const bool agrees = found && answer_ && answer_->state == GlobalState::Found &&
                      is_same_place(answer.hypotheses.front().fit.map_from_base,
                                    answer_->hypotheses.front().fit.map_from_base * moved);
  agreeing_ = found ? (agrees ? agreeing_ + 1 : 1) : 0;
  health_ = {answer.state == GlobalState::Ambiguous ? LocalizationState::Ambiguous : LocalizationState::Lost,
             found ? "found, looking once more" : answer.reason};
  if (agreeing_ >= options_.sightings_to_start) {
    const auto& fit = answer.hypotheses.front().fit;
    anchor_ = fit.map_from_base;
    covariance_ = fit.covariance + Eigen::Matrix3d(Eigen::Vector3d(1e-3, 1e-3, 1e-4).asDiagonal());
    tracking_ = true;
    misses_ = agreeing_ = 0;
    health_ = {LocalizationState::Localized, ""};
    answer_.reset();
    return;
  }
  answer_ = std::move(answer);
}

void DrawingPose::track(const localization::ScanPoints& points, const Transform2<Base, Base>& moved) {
  covariance_ = grown(covariance_, moved, anchor_, options_);
  const Transform2<Map, Base> predicted = anchor_ * moved;
  const auto fit = localization::segment_icp(points, global_.grid(), predicted, options_.icp);
  anchor_ = predicted;
  const double off_m = distance_m(fit.map_from_base.translation(), predicted.translation());
  const double off_rad = std::abs(wrap_angle(fit.map_from_base.yaw_rad() - predicted.yaw_rad()));
  if (fit.inlier_fraction < options_.sure_inliers)
    miss("too little of what is seen is drawn");
  else if (off_m > options_.most_correction_m || off_rad > options_.most_correction_rad)
    miss("walls and wheels do not agree");
  else
    correct(fit, predicted);
}

void DrawingPose::correct(const localization::RegistrationResult& fit,
                          const Transform2<Map, Base>& predicted) {
  const double floor_m = options_.scan_sigma_m * options_.scan_sigma_m;
  const Eigen::Vector3d floor(floor_m, floor_m, options_.scan_sigma_rad * options_.scan_sigma_rad);
  const Eigen::Matrix3d measured = fit.covariance + Eigen::Matrix3d(floor.asDiagonal());
  const Eigen::Matrix3d gain = covariance_ * (covariance_ + measured).inverse();
  const Eigen::Vector3d innovation(fit.map_from_base.x_m() - predicted.x_m(),
                                   fit.map_from_base.y_m() - predicted.y_m(),
                                   wrap_angle(fit.map_from_base.yaw_rad() - predicted.yaw_rad()));
  const Eigen::Vector3d step = gain * innovation;
  anchor_ = {predicted.x_m() + step.x(), predicted.y_m() + step.y(), predicted.yaw_rad() + step.z()};
  covariance_ = (Eigen::Matrix3d::Identity() - gain) * covariance_;
  misses_ = 0;
  health_ = {LocalizationState::Localized, ""};
}

void DrawingPose::miss(const std::string& reason) {
  ++misses_;
  if (misses_ >= options_.misses_to_lose) {
    tracking_ = false;
    answer_.reset();
    covariance_ = Eigen::Matrix3d::Identity() * 1e4;
    health_ = {LocalizationState::Lost, reason};
  } else if (misses_ >= options_.misses_to_degrade) {
    health_ = {LocalizationState::Degraded, reason};
  }
}

}  // namespace madori::app
