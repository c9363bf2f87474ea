#include "localization/slam/slow_lidar_mapper.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <numeric>
#include <utility>

#include "localization/global/scan_noise.hpp"
#include "localization/localizer/pose_covariance.hpp"
#include "localization/pose_axes.hpp"
#include "localization/slam/joints.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

/// While the map is young and thin the wheels know more of some directions than the scan.
void lean_on_wheels(PointIcpOptions& icp, const Transform2<Map, Base>& assumed,
                    const Eigen::Matrix3d& covariance, double residual_sigma_m) {
  icp.prior = assumed;
  icp.prior_information = residual_sigma_m * residual_sigma_m * with_floor(covariance).inverse();
}

/// Of a scan that was laid on the map: 5 cm and 1 degree.
const Eigen::Matrix3d kFitted = Eigen::Vector3d(2.5e-3, 2.5e-3, 3e-4).asDiagonal();

/// Whether a pose that was found and what was believed may be one: chi-squared of three, of 1 in 10,000.
bool agree(const Transform2<Map, Base>& found, const Belief& believed) {
  constexpr double kChiSquared = 21.1;
  const Eigen::Vector3d off = pose_difference(found, believed.map_from_base);
  return off.dot((believed.covariance + 2.0 * kFitted).ldlt().solve(off)) < kChiSquared;
}

}  // namespace

SlowLidarMapper::SlowLidarMapper(const SlowLidarOptions& options)
    : options_(options), model_(options.odometry) {}

PoseEstimate SlowLidarMapper::estimate(Stamp stamp) const {
  PoseEstimate estimate;
  estimate.stamp = stamp;
  estimate.map_from_base = anchor_ * since_scan_.motion;
  estimate.covariance = carried({anchor_, covariance_}, since_scan_).covariance + kFitted;
  estimate.health.state = is_lost_ ? LocalizationState::Lost : LocalizationState::Localized;
  if (is_lost_) estimate.health.reason = "the last scan lies nowhere in the map";
  return estimate;
}

PoseEstimate SlowLidarMapper::on_odometry(const OdometryReading& reading) {
  if (const auto raw = track_.follow(reading)) model_.extend(since_scan_, *raw);
  return estimate(reading.stamp);
}

double SlowLidarMapper::e_max_m(double noise_m) const {
  double e_max = std::max(options_.strategies.most_e_psr_m, options_.e_max_of_noise * noise_m);
  if (!e_psr_m_.empty()) {
    const auto n = static_cast<std::ptrdiff_t>(std::min(options_.recent, e_psr_m_.size()));
    const double mean = std::accumulate(e_psr_m_.end() - n, e_psr_m_.end(), 0.0) / static_cast<double>(n);
    e_max = std::max(e_max, options_.e_max_of_recent * mean);
  }
  return std::min(e_max, options_.strategies.most_e_psr_expected_m);
}

StrategyOptions SlowLidarMapper::strategies_for(const ScanPoints& points) const {
  const double noise = std::max(scan_noise_m(points), map_.noise_m());
  StrategyOptions options = with_noise(options_.strategies, noise);
  options.most_e_psr_m = e_max_m(noise);
  return options;
}

/// What the wheels say of a pose, and how surely: the uncertainty of the heading swings the way that follows.
Belief SlowLidarMapper::carried(const Belief& from, const OdometryStep& step) const {
  const Transform2<Map, Base> to = from.map_from_base * step.motion;
  const Eigen::Matrix3d j = swing(from.map_from_base, to);
  return {to,
          j * from.covariance * j.transpose() + in_map_axes(step.covariance, from.map_from_base.yaw_rad())};
}

/// A pose far from where the wheels say is not believed on one scan: halls are alike in places, and a noisy
/// scan fits where it is not. It is kept, and believed when the next scans lead to where the wheels carry it.
bool SlowLidarMapper::is_believed(const Transform2<Map, Base>& pose, const Belief& here) {
  if (agree(pose, here)) {
    elsewhere_.reset();
    return true;
  }
  const int agreed = elsewhere_ && agree(pose, elsewhere_->first) ? elsewhere_->second + 1 : 0;
  elsewhere_ = {{pose}, agreed};
  if (agreed < options_.scans_to_jump) return false;
  elsewhere_.reset();
  return true;
}

/// Whether a scan, where it was laid, contradicts the one that was accepted last. Half of any scan lies near
/// to some wall wherever it is laid; and what was seen long ago may lie beside itself where no loop was
/// closed.
bool SlowLidarMapper::sees_through_last(const ScanPoints& points, const Transform2<Map, Base>& pose,
                                        const LikelihoodOptions& options) const {
  const ScanPoints& last = scans_.back();
  std::vector<Point2<Map>> seen;
  for (std::size_t i = 0; i < last.size(); ++i) seen.push_back(poses_.back() * last.point(i));
  return contradiction(points, PointMap(std::move(seen), 0.0), pose, options) > JointOptions().most_through;
}

/// Algorithm 3: where the scan lies in the map, and is believed to.
std::optional<StrategyResult> SlowLidarMapper::laid(const ScanPoints& points, const Point2<Base>& sensor,
                                                    const Belief& assumed) {
  if (looks_.empty()) return std::nullopt;
  StrategyOptions options = strategies_for(points);
  options.likelihood.sensor = sensor;
  lean_on_wheels(options.icp, assumed.map_from_base, assumed.covariance,
                 std::max(options_.residual_sigma_m, map_.noise_m()));
  auto found = localize_around(points, map_.points(), assumed.map_from_base, options);
  if (!found || !agree(found->fit.map_from_base, assumed) ||
      sees_through_last(points, found->fit.map_from_base, options.likelihood))
    found = localize_absolutely(points, map_.points(), options);
  if (found && !is_believed(found->fit.map_from_base, assumed)) found.reset();
  return found;
}

PoseEstimate SlowLidarMapper::on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor) {
  const OdometryStep step = looks_.empty() ? OdometryStep{} : track_.between(anchor_stamp_, stamp, model_);
  const Transform2<Map, Base> before = anchor_;
  const Belief assumed = carried({before, covariance_}, step);
  if (elsewhere_) elsewhere_->first = carried(elsewhere_->first, step);
  path_m_ += step.path_m;
  const std::optional<StrategyResult> found = laid(points, sensor, assumed);
  if (!found && looks_.size() == 1 && points.size() > scans_.front().size()) begin_anew();
  const bool accepted = found || (looks_.empty() && !points.empty());
  if (accepted) note_motion(stamp, assumed, !found || agree(found->fit.map_from_base, assumed));
  anchor_ = found ? found->fit.map_from_base : assumed.map_from_base;
  covariance_ = accepted ? Eigen::Matrix3d::Zero() : assumed.covariance;
  if (found) e_psr_m_.push_back(found->fit.e_psr_m);
  if (found && !is_lost_ && found->strategy == Strategy::Rdnm)
    model_.learn(step, before.inverse() * anchor_, 0.05, 0.02);
  if (accepted) {
    map_.add(points, anchor_, sensor, scan_noise_m(points));
    looks_.push_back({stamp, sensor, path_m_});
    scans_.push_back(points);
    poses_.push_back(anchor_);
    path_m_ = 0.0;
  }
  is_lost_ = !looks_.empty() && !accepted;
  lost_ += is_lost_;
  anchor_stamp_ = stamp;
  since_scan_ = track_.since(stamp, model_);
  return estimate(stamp);
}

/// In a map of one scan that saw little nothing is ever found again: the scan that saw more begins the map.
void SlowLidarMapper::begin_anew() {
  ++lost_;
  map_ = {};
  looks_.clear();
  scans_.clear();
  poses_.clear();
  elsewhere_.reset();
}

/// The wheels' word from the scan accepted last to the one that is about to be: for the last look.
void SlowLidarMapper::note_motion(Stamp stamp, const Belief& assumed, bool is_believed) {
  if (poses_.empty()) return;
  if (!is_believed) carried_.push_back(stamp);
  const auto n = static_cast<int>(poses_.size());
  const Pose& from = poses_.back();
  const Eigen::Matrix3d covariance = in_map_axes(with_floor(assumed.covariance), -from.yaw_rad());
  motions_.push_back({n - 1, n, from.inverse() * assumed.map_from_base,
                      is_believed ? Eigen::Matrix3d(covariance.inverse()) : Eigen::Matrix3d::Zero().eval()});
}

FinishedMap SlowLidarMapper::finish() {
  poses_ = bundle_scans(scans_, std::move(poses_), motions_, map_.noise_m());
  FinishedMap finished;
  finished.lost_scans = lost_;
  finished.carried = carried_;
  map_ = {};
  const Eigen::Matrix3d information = Eigen::Vector3d(400.0, 400.0, 2500.0).asDiagonal();
  LidarNoise noise;
  SurfaceScanOptions how = options_.scan;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const auto& [stamp, sensor, path_m] = looks_[i];
    const double noise_m = scan_noise_m(scans_[i]);
    map_.add(scans_[i], poses_[i], sensor, noise_m);
    how.noise_m = noise.after(noise_m);
    finished.memory.add(make_surface_scan(stamp, sensor, weighty_points(scans_[i]), how), path_m, poses_[i],
                        information);
    finished.scans.push_back({stamp, poses_[i]});
  }
  return finished;
}

}  // namespace madori::localization
