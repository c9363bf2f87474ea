#include "localization/localizer/localizer.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace madori::localization {
namespace {

std::vector<Point2<Base>> to_points(const ScanPoints& points) {
  std::vector<Point2<Base>> out;
  out.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.weight_of(i) > 0.0) {
      out.push_back(points.point(i));
    }
  }
  return out;
}

/// A covariance in the axes of a pose of the given heading, in Map axes.
Eigen::Matrix3d in_map_axes(const Eigen::Matrix3d& covariance, double yaw_rad) {
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  r(0, 0) = r(1, 1) = std::cos(yaw_rad);
  r(0, 1) = -std::sin(yaw_rad);
  r(1, 0) = std::sin(yaw_rad);
  return r * covariance * r.transpose();
}

/// What a step of the wheels never gets more exact than: 5 mm, 0.3 degrees.
Eigen::Matrix3d with_floor(const Eigen::Matrix3d& covariance) {
  return covariance + Eigen::Matrix3d(Eigen::Vector3d(2.5e-5, 2.5e-5, 2.5e-5).asDiagonal());
}

}  // namespace

Localizer::Localizer(const mapping::Walls& walls, const InitialPose& initial, const LocalizerOptions& options)
    : options_(options),
      initial_(initial),
      model_(options.odometry),
      memory_(options.memory),
      anchor_(initial.map_from_base) {
  if (!walls.empty()) {
    drawing_.emplace(walls);
  }
}

PoseEstimate Localizer::estimate(Stamp stamp, const Transform2<Map, Base>& map_from_base) const {
  PoseEstimate estimate;
  estimate.stamp = stamp;
  estimate.map_from_base = map_from_base;
  estimate.covariance = covariance_;
  return estimate;
}

PoseEstimate Localizer::on_odometry(const OdometryReading& reading) {
  const OdometryReading before = track_.empty() ? reading : track_.newest();
  const bool usable = reading.odom_from_base.is_finite();
  const Transform2<Base, Base> raw =
      usable ? before.odom_from_base.inverse() * reading.odom_from_base : Transform2<Base, Base>();
  if (!track_.add(reading)) {  // late or broken: answered, not used
    return estimate(reading.stamp, anchor_ * since_scan_.motion * raw);
  }
  model_.extend(since_scan_, raw);
  model_.extend(since_keyframe_, raw);
  return estimate(reading.stamp, anchor_ * since_scan_.motion);
}

MatchResult Localizer::match(const SurfaceScan& scan, const OdometryStep& step) const {
  const Transform2<Map, Base> prediction = anchor_ * step.motion;
  const Eigen::Matrix3d covariance = with_floor(in_map_axes(step.covariance, anchor_.yaw_rad()));
  const MatchPrior prior{prediction, covariance.inverse()};
  const LocalMap map = memory_.recent_map(prediction.translation());
  SearchWindow window;
  window.sigma_m = std::sqrt(std::max(covariance(0, 0), covariance(1, 1)));
  window.sigma_rad = std::sqrt(covariance(2, 2));
  window.half_m = std::clamp(3.0 * window.sigma_m, std::min(1.0, 0.15 + 2.0 * step.path_m), 1.0);
  window.half_rad = std::clamp(3.0 * window.sigma_rad, 0.05, 0.8);
  ExtraPull pull;
  if (drawing_ && drawing_->model().sigma_m < options_.exact_drawing_m) {
    pull = [&](const Transform2<Map, Base>& pose, Eigen::Matrix3d& hessian, Eigen::Vector3d& gradient) {
      drawing_->pull(scan, pose, hessian, gradient);
    };
  }
  const MatchResult near = map.refine(scan, map.search(scan, prediction, window).map_from_base, prior, pull);
  if (near.inlier_share > options_.sure_inliers) {
    return near;
  }
  window.half_m = 0.5 + 0.5 * std::min(2.0, step.path_m);
  window.half_rad = 0.8;
  const MatchResult far = map.refine(scan, map.search(scan, prediction, window).map_from_base, prior);
  return far.inlier_share > near.inlier_share + 0.05 ? far : near;
}

void Localizer::start(SurfaceScan scan) {
  anchor_stamp_ = scan.stamp;
  memory_.add({std::move(scan), 0.0}, anchor_, Eigen::Matrix3d::Zero());
  since_scan_ = {};
  since_keyframe_ = {};
  if (drawing_) {
    consult_drawing();
    anchor_ = memory_.poses().back();
  }
}

void Localizer::remember(SurfaceScan scan, const MatchResult& match) {
  const Transform2<Map, Base> last = memory_.poses().back();
  const Eigen::Matrix3d wheels = with_floor(since_keyframe_.covariance).inverse();
  const Eigen::Matrix3d seen = in_map_axes(match.information, -last.yaw_rad());
  const double path = memory_.keyframes().back().path_m + since_keyframe_.path_m;
  memory_.add({std::move(scan), path}, match.map_from_base, seen + wheels);
  since_keyframe_ = {};
  memory_.close_loops();
  ++keyframes_since_solve_;
  if (is_solve_due()) {
    keyframes_since_solve_ = 0;
    if (drawing_) {
      consult_drawing();
    } else if (memory_.loops() > 0) {
      memory_.optimise({});
    }
  }
  anchor_ = memory_.poses().back();
}

bool Localizer::is_solve_due() const {
  const std::size_t size = memory_.size();
  return size < 20 || keyframes_since_solve_ >= (size < 200 ? 4 : 8);
}

/// How far off the believed start the first keyframe lies, nats.
double Localizer::surprise(const Transform2<Map, Base>& first) const {
  const double d = distance_m(first.translation(), initial_.map_from_base.translation()) / initial_.sigma_m;
  const double a = wrap_angle(first.yaw_rad() - initial_.map_from_base.yaw_rad()) / initial_.sigma_rad;
  return 0.5 * (d * d + a * a);
}

void Localizer::consult_drawing() {
  MemoryCloud cloud = memory_cloud(memory_);
  const Alignment found = drawing_->align(cloud, {});
  const Transform2<Map, Base>& first = memory_.poses().front();
  const double gain = found.gain - surprise(found.correction * first) + surprise(first);
  if (gain > options_.move_gain) {
    memory_.move(found.correction);
    cloud = memory_cloud(memory_);
  }
  drawing_->learn(cloud);
  if (correct_recent_drift()) {
    cloud = memory_cloud(memory_);
  }
  std::vector<UnaryFactor> unary = drawing_->pulls(cloud, memory_.poses());
  UnaryFactor start;
  start.at = initial_.map_from_base;
  start.hessian = Eigen::Vector3d(1.0 / (initial_.sigma_m * initial_.sigma_m),
                                  1.0 / (initial_.sigma_m * initial_.sigma_m),
                                  1.0 / (initial_.sigma_rad * initial_.sigma_rad))
                      .asDiagonal();
  unary.push_back(start);
  memory_.optimise(unary);
}

/// On an exact drawing, a stretch that lies beside it by many times the drawing's own error has drifted:
/// the walls it belongs to are sought anew. On a rough drawing the building's own shape is the better guide.
bool Localizer::correct_recent_drift() {
  const std::size_t first = memory_.window_begin();
  if (drawing_->model().sigma_m > options_.exact_drawing_m || first == 0) {
    return false;
  }
  const Alignment found = drawing_->align(memory_cloud(memory_, first), {0.8, 0.09});
  const Point2<Map> here = memory_.poses().back().translation();
  if (found.gain < 2.0 * options_.move_gain ||
      distance_m(found.correction * here, here) < 3.0 * drawing_->model().sigma_m) {
    return false;
  }
  memory_.move(found.correction, first);
  return true;
}

PoseEstimate Localizer::on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor) {
  SurfaceScan scan = make_surface_scan(stamp, sensor, to_points(points), options_.scan);
  if (memory_.empty()) {
    if (!scan.points.empty()) {
      start(std::move(scan));
    }
    return estimate(stamp, anchor_);
  }
  if (stamp < anchor_stamp_) {
    return estimate(stamp, match(scan, OdometryStep{}).map_from_base);
  }
  const OdometryStep step = track_.between(anchor_stamp_, stamp, model_);
  MatchResult matched = match(scan, step);
  const bool fits = matched.inlier_share > options_.lost_inliers;
  if (!fits) {
    matched.map_from_base = anchor_ * step.motion;
    matched.information.setZero();
  }
  if (fits) {
    model_.learn(step, anchor_.inverse() * matched.map_from_base, 0.02, 0.005);
  }
  anchor_ = matched.map_from_base;
  anchor_stamp_ = stamp;
  since_scan_ = track_.empty() ? OdometryStep{} : track_.between(stamp, track_.newest().stamp, model_);
  const Transform2<Base, Base> moved = memory_.poses().back().inverse() * anchor_;
  if (std::hypot(moved.x_m(), moved.y_m()) > options_.keyframe_m ||
      std::abs(moved.yaw_rad()) > options_.keyframe_rad) {
    remember(std::move(scan), matched);
  }
  return estimate(stamp, anchor_);
}

}  // namespace madori::localization
