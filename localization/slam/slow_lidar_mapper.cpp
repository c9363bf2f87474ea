#include "localization/slam/slow_lidar_mapper.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <numeric>
#include <utility>

#include "localization/global/scan_noise.hpp"
#include "localization/localizer/pose_covariance.hpp"

namespace madori::localization {
namespace {

/// While the map is young and thin the wheels know more of some directions than the scan.
void lean_on_wheels(PointIcpOptions& icp, const Transform2<Map, Base>& assumed,
                    const Eigen::Matrix3d& covariance, double residual_sigma_m) {
  icp.prior = assumed;
  icp.prior_information = residual_sigma_m * residual_sigma_m * with_floor(covariance).inverse();
}

}  // namespace

SlowLidarMapper::SlowLidarMapper(const SlowLidarOptions& options)
    : options_(options), model_(options.odometry), map_(options.map) {}

PoseEstimate SlowLidarMapper::estimate(Stamp stamp) const {
  PoseEstimate estimate;
  estimate.stamp = stamp;
  estimate.map_from_base = anchor_ * since_scan_.motion;
  estimate.covariance = in_map_axes(since_scan_.covariance, anchor_.yaw_rad()) +
                        Eigen::Matrix3d(Eigen::Vector3d(1e-3, 1e-3, 1e-4).asDiagonal());
  estimate.health.state = is_lost_ ? LocalizationState::Lost : LocalizationState::Localized;
  if (is_lost_) estimate.health.reason = "the last scan lies nowhere in the map";
  return estimate;
}

PoseEstimate SlowLidarMapper::on_odometry(const OdometryReading& reading) {
  const OdometryReading before = track_.empty() ? reading : track_.newest();
  if (track_.add(reading))
    model_.extend(since_scan_, before.odom_from_base.inverse() * reading.odom_from_base);
  return estimate(reading.stamp);
}

double SlowLidarMapper::e_max_m(double noise_m) const {
  double e_max = std::max(options_.strategies.most_e_psr_m, options_.e_max_of_noise * noise_m);
  if (!e_psr_m_.empty()) {
    const auto n = static_cast<std::ptrdiff_t>(std::min(options_.recent, e_psr_m_.size()));
    const double mean = std::accumulate(e_psr_m_.end() - n, e_psr_m_.end(), 0.0) / static_cast<double>(n);
    e_max = std::max(e_max, options_.e_max_of_recent * mean);
  }
  return std::min(e_max, options_.most_e_max_m);
}

StrategyOptions SlowLidarMapper::strategies_for(const ScanPoints& points) const {
  const double noise = std::max(scan_noise_m(points), map_.noise_m());
  StrategyOptions options = options_.strategies;
  options.most_e_psr_m = e_max_m(noise);
  options.icp.last_scale_m = std::max(options.icp.last_scale_m, 1.5 * noise);
  options.icp.inlier_distance_m = std::max(options.icp.inlier_distance_m, noise);
  return options;
}

PoseEstimate SlowLidarMapper::on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor) {
  const OdometryStep step = started_ ? track_.between(anchor_stamp_, stamp, model_) : OdometryStep{};
  const Transform2<Map, Base> before = anchor_;
  const Transform2<Map, Base> assumed = before * step.motion;
  path_m_ += step.path_m;
  std::optional<StrategyResult> found;
  if (started_) {
    StrategyOptions options = strategies_for(points);
    lean_on_wheels(options.icp, assumed, in_map_axes(step.covariance, before.yaw_rad()),
                   std::max(options_.residual_sigma_m, map_.noise_m()));
    found = localize_relatively(points, map_.points(), assumed, options);
  }
  const bool accepted = found || (!started_ && !points.empty());
  anchor_ = found ? found->fit.map_from_base : assumed;
  if (found) e_psr_m_.push_back(found->fit.e_psr_m);
  if (found && !is_lost_ && found->strategy == Strategy::Rdnm)
    model_.learn(step, before.inverse() * anchor_, 0.05, 0.02);
  if (accepted) {
    map_.add(points, anchor_, sensor, scan_noise_m(points));
    const Eigen::Matrix3d information = Eigen::Vector3d(400.0, 400.0, 2500.0).asDiagonal();
    finished_.memory.add(make_surface_scan(stamp, sensor, weighty_points(points), options_.scan), path_m_,
                         anchor_, information);
    finished_.scans.push_back({stamp, anchor_});
    path_m_ = 0.0;
  }
  is_lost_ = started_ && !accepted;
  lost_ += is_lost_;
  started_ = started_ || accepted;
  anchor_stamp_ = stamp;
  since_scan_ = track_.empty() ? OdometryStep{} : track_.between(stamp, track_.newest().stamp, model_);
  return estimate(stamp);
}

FinishedMap SlowLidarMapper::finish() {
  finished_.lost_scans = lost_;
  return std::move(finished_);
}

}  // namespace madori::localization
