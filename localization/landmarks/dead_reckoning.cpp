#include "localization/landmarks/dead_reckoning.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "localization/localizer/options.hpp"
#include "localization/pose_axes.hpp"

namespace madori::localization::landmarks {
namespace {

const LocalizerOptions kAsTheLocalizer;
constexpr double kFarMargin = 0.1;  ///< by which a wider search must explain more

Transform2<Odom, Base> in_odom(const Transform2<Map, Base>& pose) {
  return {pose.x_m(), pose.y_m(), pose.yaw_rad()};
}

Matrix3 matrix(const Eigen::Matrix3d& m) {
  Matrix3 out;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out(i, j) = m(i, j);
  return out;
}

}  // namespace

DeadReckoning::DeadReckoning(bool match_scans, const MemoryOptions& options)
    : match_scans_(match_scans), options_(options), recent_(options) {}

Transform2<Odom, Base> DeadReckoning::on_odometry(const OdometryReading& reading) {
  if (const auto raw = track_.follow(reading)) model_.extend(since_scan_, *raw);
  return in_odom(at_scan_ * since_scan_.motion);
}

Transform2<Odom, Base> DeadReckoning::on_scan(Stamp stamp, const ScanPoints& points,
                                              const Point2<Base>& sensor) {
  if (last_scan_ && stamp <= *last_scan_) return in_odom(at_scan_ * since_scan_.motion);
  const OdometryStep step = last_scan_ ? track_.between(*last_scan_, stamp, model_) : OdometryStep{};
  if (match_scans_) {
    match(make_surface_scan(stamp, sensor, weighty_points(points)), step);
  } else {
    at_scan_ = at_scan_ * step.motion;
    const auto& m = step.motion;
    motion_ = added(motion_, {{m.x_m(), m.y_m(), m.yaw_rad()}, {matrix(step.covariance)}});
  }
  last_scan_ = stamp;
  since_scan_ = track_.since(stamp, model_);
  return in_odom(at_scan_ * since_scan_.motion);
}

/// Lays the scan on the recent keyframes, near where the wheels say. What a match cannot know of itself grows
/// with the way (MemoryOptions::chain_m).
void DeadReckoning::match(const SurfaceScan& scan, const OdometryStep& step) {
  const Transform2<Map, Base> prediction = at_scan_ * step.motion;
  Eigen::Matrix3d covariance = in_map_axes(step.covariance, at_scan_.yaw_rad());
  covariance.diagonal() += Eigen::Vector3d(1e-4, 1e-4, 1e-5);
  const double path_m = std::max(step.path_m, 0.1 * step.turned_rad);
  Eigen::Matrix3d error = step.covariance;
  Transform2<Map, Base> here = prediction;
  if (!recent_.empty()) {
    const LocalMap& map = recent_.recent_map(prediction.translation());
    SearchWindow window;
    window.sigma_m = std::sqrt(std::max(covariance(0, 0), covariance(1, 1)));
    window.sigma_rad = std::sqrt(covariance(2, 2));
    window.half_m = std::clamp(3.0 * window.sigma_m, 0.1, 1.0);
    window.half_rad = std::clamp(3.0 * window.sigma_rad, 0.05, 0.8);
    const MatchPrior prior{prediction, covariance.inverse()};
    const auto search_and_refine = [&] {
      return map.refine(scan, map.search(scan, prediction, window).map_from_base, prior);
    };
    MatchResult found = search_and_refine();
    if (found.inlier_share < kAsTheLocalizer.sure_inliers) {  // the wheels may have slipped
      window.half_m = 0.5 + 0.5 * std::min(2.0, step.path_m);
      window.half_rad = 0.8;
      const MatchResult far = search_and_refine();
      if (far.inlier_share > found.inlier_share + kFarMargin) found = far;
    }
    if (found.inlier_share > kAsTheLocalizer.lost_inliers) {
      here = found.map_from_base;
      const Eigen::Vector3d grown =
          path_m * Eigen::Vector3d(options_.chain_m * options_.chain_m, options_.chain_m * options_.chain_m,
                                   options_.chain_rad * options_.chain_rad);
      const Eigen::Matrix3d fit = (found.information + covariance.inverse()).inverse();
      // Keyframes a few metres back are matched against: the fit's own error does not add up scan by scan.
      error = in_map_axes(fit, -at_scan_.yaw_rad()) * std::min(1.0, path_m / options_.window_path_m);
      error.diagonal() += grown;
      model_.learn(step, at_scan_.inverse() * here);
    }
  }
  const Transform2<Base, Base> moved = at_scan_.inverse() * here;
  motion_ = added(motion_, {{moved.x_m(), moved.y_m(), moved.yaw_rad()}, {matrix(error)}});
  at_scan_ = here;
  since_keyframe_m_ += step.path_m;
  if (!recent_.empty() && !is_new_view(recent_.poses().back().inverse() * here, kAsTheLocalizer)) return;
  recent_.add(scan, since_keyframe_m_, here, MeasuredMotion{});
  since_keyframe_m_ = 0.0;
}

FullPose DeadReckoning::take_motion() {
  const FullPose motion = motion_;
  motion_ = {};
  return motion;
}

}  // namespace madori::localization::landmarks
