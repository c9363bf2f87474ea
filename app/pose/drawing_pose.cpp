#include "app/pose/drawing_pose.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/angle.hpp"

namespace madori::app {
namespace {

constexpr double kSamePlaceM = 0.3;
constexpr double kSamePlaceRad = 0.1;
constexpr std::size_t kMostHypotheses = 10;
constexpr double kLeastProbability = 1e-3;

bool is_same_place(const Transform2<Map, Base>& a, const Transform2<Map, Base>& b) {
  return distance_m(a.translation(), b.translation()) < kSamePlaceM &&
         std::abs(wrap_angle(a.yaw_rad() - b.yaw_rad())) < kSamePlaceRad;
}

/// Starts for registration within two sigma of a given pose: half a metre and ten degrees apart, so that
/// each pose between them is drawn to the same walls.
std::vector<Transform2<Map, Base>> around(const Transform2<Map, Base>& given, const PoseSigma& sigma) {
  constexpr double kStepM = 0.5;
  constexpr double kStepRad = 0.17;
  constexpr int kMost = 8;
  const int n = std::min(kMost, static_cast<int>(std::ceil(2.0 * sigma.position_m / kStepM)));
  const int turns = std::min(kMost, static_cast<int>(std::ceil(2.0 * sigma.yaw_rad / kStepRad)));
  const double step_m = 2.0 * sigma.position_m / n;
  const double step_rad = 2.0 * std::min(sigma.yaw_rad, kPi / 2.0) / turns;
  std::vector<Transform2<Map, Base>> starts;
  for (int i = -n; i <= n; ++i)
    for (int j = -n; j <= n; ++j)
      for (int k = -turns; k <= turns; ++k)
        if (i * i + j * j <= n * n)
          starts.emplace_back(given.x_m() + i * step_m, given.y_m() + j * step_m,
                              given.yaw_rad() + k * step_rad);
  return starts;
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
  odom_ = reading.odom_from_base;
  const auto moved = anchor_odom_.inverse() * odom_;
  return {reading.stamp, anchor_ * moved, grown(covariance_, moved, anchor_, options_), health_};
}

void DrawingPose::on_cloud(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& odom_from_base) {
  const auto points = localization::extract_walls(cloud, options_.walls);
  const auto moved = anchor_odom_.inverse() * odom_from_base;
  anchor_odom_ = odom_from_base;
  if (given_)
    check_given(points, moved);
  else if (tracking_)
    track(points, moved);
  else
    search(points, moved);
}

void DrawingPose::set_pose(const Transform2<Map, Base>& map_from_base, const PoseSigma& sigma) {
  given_ = sigma;
  anchor_ = map_from_base;
  anchor_odom_ = odom_;
  const double m2 = sigma.position_m * sigma.position_m;
  covariance_ = Eigen::Vector3d(m2, m2, sigma.yaw_rad * sigma.yaw_rad).asDiagonal();
  health_ = {LocalizationState::Lost, "comparing what is seen with the place that was given"};
}

void DrawingPose::search_anew() {
  tracking_ = false;
  given_.reset();
  answer_.reset();
  agreeing_ = 0;
  covariance_ = Eigen::Matrix3d::Identity() * 1e4;
  health_ = {LocalizationState::Lost, "looking for the place on the drawing"};
}

void DrawingPose::check_given(const localization::ScanPoints& points, const Transform2<Base, Base>& moved) {
  anchor_ = anchor_ * moved;
  answer_ = global_.judge(points, around(anchor_, *given_));
  given_.reset();
  tracking_ = false;
  agreeing_ = 0;
  if (answer_->state == localization::GlobalState::Found)
    start_at(answer_->hypotheses.front().fit);
  else
    health_ = {answer_->state == localization::GlobalState::Ambiguous ? LocalizationState::Ambiguous
                                                                      : LocalizationState::Lost,
               "what is seen does not fit the place that was given: " + answer_->reason};
}

void DrawingPose::start_at(const localization::RegistrationResult& fit) {
  anchor_ = fit.map_from_base;
  explained_ = fit.inlier_fraction;
  covariance_ = fit.covariance + Eigen::Matrix3d(Eigen::Vector3d(1e-3, 1e-3, 1e-4).asDiagonal());
  tracking_ = true;
  misses_ = agreeing_ = 0;
  health_ = {LocalizationState::Localized, ""};
  answer_.reset();
}

std::vector<PoseHypothesis> DrawingPose::hypotheses() const {
  const auto moved = anchor_odom_.inverse() * odom_;
  if (given_ || (tracking_ && !answer_)) return {{anchor_ * moved, 1.0, explained_}};
  std::vector<PoseHypothesis> list;
  if (!answer_) return list;
  for (const auto& h : answer_->hypotheses)
    if (list.size() < kMostHypotheses && h.probability >= kLeastProbability)
      list.push_back({h.fit.map_from_base * moved, h.probability, h.fit.inlier_fraction});
  return list;
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
    start_at(answer.hypotheses.front().fit);
    return;
  }
  answer_ = std::move(answer);
}

void DrawingPose::track(const localization::ScanPoints& points, const Transform2<Base, Base>& moved) {
  covariance_ = grown(covariance_, moved, anchor_, options_);
  const Transform2<Map, Base> predicted = anchor_ * moved;
  const auto fit = localization::segment_icp(points, global_.grid(), predicted, options_.icp);
  anchor_ = predicted;
  explained_ = fit.inlier_fraction;
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
    search_anew();
    health_.reason = reason;
  } else if (misses_ >= options_.misses_to_degrade) {
    health_ = {LocalizationState::Degraded, reason};
  }
}

}  // namespace madori::app
