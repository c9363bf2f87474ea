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

Localizer::Localizer(const mapping::Walls& walls, const std::optional<InitialPose>& initial,
                     const LocalizerOptions& options)
    : options_(options),
      initial_(initial.value_or(InitialPose{})),
      model_(options.odometry),
      memory_(options.memory),
      anchor_(initial_.map_from_base) {
  evidence_.has_drawing = !walls.empty();
  if (!walls.empty()) {
    drawing_.emplace(walls);
    evidence_.searching = !initial;
  }
}

HealthEvidence Localizer::evidence_with_time(Stamp stamp) const {
  HealthEvidence evidence = evidence_;
  if (evidence.blind_scans > 0) {
    evidence.blind_s = to_seconds(stamp - last_agreed_);
  }
  return evidence;
}

/// Did the drawing explain the memory before? Only then is it any use for finding the place again.
bool Localizer::drawing_fits() const {
  return evidence_.fit_nats > options_.health.verified_nats &&
         evidence_.fit_nats > options_.health.good_nats_a_wall * evidence_.walls_seen;
}

PoseEstimate Localizer::estimate(Stamp stamp, const Transform2<Map, Base>& map_from_base) const {
  PoseEstimate estimate;
  estimate.stamp = stamp;
  estimate.map_from_base = map_from_base;
  estimate.covariance = covariance_ + in_map_axes(since_scan_.covariance, anchor_.yaw_rad());
  HealthEvidence evidence = evidence_with_time(stamp);
  evidence.position_sigma_m = std::sqrt(std::max(estimate.covariance(0, 0), estimate.covariance(1, 1)));
  estimate.health = judge(evidence, options_.health);
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
  MatchResult best = match_from(anchor_, scan, step);
  if (late_anchor_ && best.inlier_share < options_.sure_inliers) {
    const MatchResult late = match_from(*late_anchor_, scan, step);
    best = late.inlier_share > best.inlier_share ? late : best;
  }
  return best;
}

MatchResult Localizer::match_from(const Transform2<Map, Base>& anchor, const SurfaceScan& scan,
                                  const OdometryStep& step) const {
  const Transform2<Map, Base> prediction = anchor * step.motion;
  const Eigen::Matrix3d covariance = with_floor(in_map_axes(step.covariance, anchor.yaw_rad()));
  const MatchPrior prior{prediction, covariance.inverse()};
  const LocalMap map = memory_.recent_map(prediction.translation());
  SearchWindow window;
  window.sigma_m = std::sqrt(std::max(covariance(0, 0), covariance(1, 1)));
  window.sigma_rad = std::sqrt(covariance(2, 2));
  window.half_m = std::clamp(3.0 * window.sigma_m, std::min(0.3, 0.15 + 2.0 * step.path_m), 1.0);
  window.half_rad = std::clamp(3.0 * window.sigma_rad, 0.05, 0.8);
  ExtraPull pull;
  if (drawing_ && drawing_->model().sigma_m < options_.exact_drawing_m) {
    pull = [&](const Transform2<Map, Base>& pose, Eigen::Matrix3d& hessian, Eigen::Vector3d& gradient) {
      drawing_->pull(scan, pose, hessian, gradient);
    };
  }
  MatchResult near = map.refine(scan, map.search(scan, prediction, window).map_from_base, prior, pull);
  if (near.inlier_share > options_.sure_inliers) {
    return near;
  }
  window.half_m = 0.5 + 0.5 * std::min(2.0, step.path_m);
  window.half_rad = 0.8;
  const LocalMap whole = memory_.whole_map(prediction.translation());
  MatchResult far = whole.refine(scan, whole.search(scan, prediction, window).map_from_base, prior, pull);
  // The farther from what the wheels say, the clearer the scan must speak.
  const Transform2<Base, Base> off = prediction.inverse() * far.map_from_base;
  const double metres = std::hypot(off.x_m(), off.y_m()) / window.sigma_m;
  const double turns = off.yaw_rad() / window.sigma_rad;
  const double margin = 0.05 + 0.03 * std::log1p(metres * metres + turns * turns);
  return far.inlier_share > near.inlier_share + margin ? far : near;
}

void Localizer::start(SurfaceScan scan) {
  anchor_stamp_ = scan.stamp;
  last_agreed_ = scan.stamp;
  memory_.add({std::move(scan), 0.0}, anchor_, Eigen::Matrix3d::Zero());
  since_scan_ = {};
  since_keyframe_ = {};
  if (drawing_ && evidence_.searching) {
    next_survey_walls_ = 0.0;
    look_everywhere();
  } else if (drawing_) {
    consult_drawing();
  }
  anchor_ = memory_.poses().back();
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
    if (drawing_ && evidence_.searching) {
      look_everywhere();
    } else if (drawing_) {
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

/// Does the scan agree with the memory and with the drawing as scans usually do here? Once in doubt, the
/// memory alone does not clear it: what was added since the doubt began agrees with itself anywhere.
void Localizer::note_agreement(const SurfaceScan& scan, const MatchResult& match, const OdometryStep& step) {
  const bool drawing_speaks = drawing_ && !evidence_.searching && drawing_fits();
  const double on_walls = drawing_speaks ? drawing_->share_on_walls(scan, match.map_from_base) : 0.0;
  const bool exact = drawing_speaks && drawing_->model().sigma_m < options_.exact_drawing_m;
  bool agrees = match.inlier_share > std::max(options_.lost_inliers, 0.5 * usual_inliers_);
  if (exact) {  // in a furnished room of a rough drawing, few returns are on drawn walls anyway
    agrees = agrees && on_walls > 0.5 * usual_on_walls_;
  }
  if (!agrees) {
    ++evidence_.blind_scans;
    evidence_.blind_m += step.path_m;
    return;
  }
  usual_inliers_ += 0.05 * (match.inlier_share - usual_inliers_);
  if (drawing_speaks) {
    usual_on_walls_ += 0.05 * (on_walls - usual_on_walls_);
  }
  last_agreed_ = scan.stamp;
  evidence_.blind_scans = 0;
  evidence_.blind_m = 0.0;
}

/// What the scan says, and what the drawing's own error adds: walls that are drawn wrong lead all alike.
void Localizer::update_covariance(const MatchResult& match) {
  const Eigen::Matrix3d floor = Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();
  covariance_ = (match.information + Eigen::Matrix3d::Identity()).inverse() + floor;
  if (drawing_ && evidence_.walls_seen > 0.0) {
    const double share = drawing_->model().sigma_m * drawing_->model().sigma_m;
    const double walls = std::max(1.0, 0.1 * evidence_.inliers * evidence_.walls_seen);
    covariance_.diagonal() += Eigen::Vector3d(share, share, 0.01 * share) * (1.0 + 4.0 / walls) * 0.5;
  }
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
    late_anchor_ = match(scan, OdometryStep{}).map_from_base;  // which of the two clocks is right shows next
    return estimate(stamp, *late_anchor_);
  }
  const OdometryStep step = track_.between(anchor_stamp_, stamp, model_);
  MatchResult matched = match(scan, step);
  late_anchor_.reset();
  note_agreement(scan, matched, step);
  const bool fits = matched.inlier_share > options_.lost_inliers;
  if (!fits) {
    matched.map_from_base = anchor_ * step.motion;
    matched.information.setZero();
    memory_.note_break();
    since_keyframe_.covariance += Eigen::Vector3d(0.04, 0.04, 0.25).asDiagonal();  // wheels may have slipped
  }
  if (fits) {
    model_.learn(step, anchor_.inverse() * matched.map_from_base, 0.02, 0.005);
  }
  anchor_ = matched.map_from_base;
  anchor_stamp_ = stamp;
  update_covariance(matched);
  since_scan_ = track_.empty() ? OdometryStep{} : track_.between(stamp, track_.newest().stamp, model_);
  if (drawing_ && drawing_->model().sigma_m < options_.exact_drawing_m && !evidence_.searching &&
      evidence_.blind_scans >= options_.health.blind_scans &&
      judge(evidence_with_time(stamp), options_.health).state == LocalizationState::Lost && drawing_fits()) {
    start_search();
    start(std::move(scan));
    return estimate(stamp, anchor_);
  }
  const Transform2<Base, Base> moved = memory_.poses().back().inverse() * anchor_;
  if (std::hypot(moved.x_m(), moved.y_m()) > options_.keyframe_m ||
      std::abs(moved.yaw_rad()) > options_.keyframe_rad) {
    remember(std::move(scan), matched);
  }
  return estimate(stamp, anchor_);
}

}  // namespace madori::localization
