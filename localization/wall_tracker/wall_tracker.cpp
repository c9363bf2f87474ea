#include "localization/wall_tracker/wall_tracker.hpp"

#include <cmath>
#include <utility>

#include "localization/health/reasons.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

/// Of (x, y, yaw), independent of each other: m^2, rad^2.
Eigen::Matrix3d variances(double x_m2, double y_m2, double yaw_rad2) {
  return Eigen::Vector3d(x_m2, y_m2, yaw_rad2).asDiagonal();
}

}  // namespace

WallTracker::WallTracker(const mapping::Walls& walls, const WallTrackerOptions& options)
    : options_(options),
      global_(walls),
      model_(options.odometry),
      search_(options.sightings_to_start),
      surroundings_(options.surroundings),
      distant_(options.distant) {}

PoseEstimate WallTracker::estimate(Stamp stamp) const {
  PoseFilter ahead = filter_;
  ahead.predict(since_scan_);
  return {stamp, ahead.pose(), ahead.covariance(), health_};
}

PoseEstimate WallTracker::on_odometry(const OdometryReading& reading) {
  const OdometryReading before = track_.empty() ? reading : track_.newest();
  if (track_.add(reading))
    model_.extend(since_scan_, before.odom_from_base.inverse() * reading.odom_from_base);
  return estimate(reading.stamp);
}

PoseEstimate WallTracker::on_scan(Stamp stamp, const ScanPoints& seen) {
  if (stamp < scan_stamp_ && !search_.is_given()) return estimate(stamp);
  const ScanPoints points = scale_.applied(seen);
  const OdometryStep step = track_.between(scan_stamp_, stamp, model_);
  if (stamp - scan_stamp_ > RecentView::kRecent) {
    unbroken_ = false;
    distant_.unsettle();
  }
  evidence_ = {};
  surroundings_.take(stamp, points);
  const Pose before = filter_.pose();
  filter_.predict(step);
  if (tracking_)
    track(points, step, before);
  else
    search(points, step.motion);
  evidence_.kept = surroundings_.kept();
  if (tracking_)
    if (const auto there = nearby_.observe(points, global_.grid(), filter_.pose(), step.motion))
      place_at(*there);
  if (tracking_) learn_scale(seen, step);
  scan_stamp_ = stamp;
  since_scan_ = track_.empty() ? OdometryStep{} : track_.between(stamp, track_.newest().stamp, model_);
  return {stamp, filter_.pose(), filter_.covariance(), health_};
}

void WallTracker::set_pose(const Pose& map_from_base, const PoseSigma& sigma) {
  search_anew();
  search_.give(sigma);
  scan_stamp_ = track_.empty() ? scan_stamp_ : track_.newest().stamp;
  since_scan_ = {};
  const double m2 = sigma.position_m * sigma.position_m;
  filter_.place(map_from_base, variances(m2, m2, sigma.yaw_rad * sigma.yaw_rad));
  health_.reason = reason::kComparing.english;
}

void WallTracker::search_anew() {
  lose(reason::kSearching.english);
}

void WallTracker::lose(const std::string& reason, std::optional<GlobalAnswer> answer) {
  tracking_ = false;
  scale_.lose();
  search_.restart(std::move(answer));
  filter_.lose();
  health_ = {LocalizationState::Lost, reason};
}

void WallTracker::search(const ScanPoints& points, const Transform2<Base, Base>& moved) {
  if (!search_.is_given() && surroundings_.compare(moved, moved) == Surroundings::Others) search_.restart();
  const Sighting sighting = search_.observe(points, moved, filter_.pose(), global_);
  if (sighting.found)
    start_at(*sighting.found, points);
  else
    health_ = sighting.health;
}

void WallTracker::start_at(const RegistrationResult& found, const ScanPoints& points) {
  const RegistrationResult fit = nearby_.begin(points, global_.grid(), found);
  search_.restart();
  distant_.restart();
  place_at(fit);
  tracking_ = true;
  misses_ = 0;
  unbroken_ = true;
  evidence_.explained = fit.inlier_fraction;
  health_ = {LocalizationState::Localized, ""};
}

void WallTracker::track(const ScanPoints& points, const OdometryStep& step, const Pose& before) {
  constexpr std::size_t kFewest = 20;
  if (points.size() < kFewest) return miss(reason::kSeesNothing.english, true);
  const RegistrationResult fit = segment_icp(points, global_.grid(), filter_.pose(), options_.icp);
  evidence_ = evidence_of(points, fit, filter_.pose(), global_);
  const bool far_off = evidence_.correction_m > options_.most_correction_m ||
                       evidence_.correction_rad > options_.most_correction_rad;
  const Surroundings around =
      surroundings_.compare(step.motion, far_off ? step.motion : before.inverse() * fit.map_from_base);
  if (around == Surroundings::Others) return lose(reason::kOtherSurroundings.english);
  const bool has_changed = around == Surroundings::Changed;
  const bool little_drawn = fit.inlier_fraction < options_.sure_inliers;
  if (distant_.wants_look(evidence_, little_drawn || far_off, has_changed, step.motion) &&
      is_contradicted(points, fit, has_changed))
    return;
  if (little_drawn)
    miss(reason::kLittleDrawn.english, !wheels_still_do());
  else if (far_off)
    miss(reason::kWallsAndWheels.english, true);
  else
    correct(fit, step);
}

/// Looks at all places; true where the vehicle is lost by it.
bool WallTracker::is_contradicted(const ScanPoints& points, const RegistrationResult& fit, bool has_changed) {
  evidence_.looked_elsewhere = true;
  GlobalAnswer here;
  here.hypotheses.push_back({fit, 0.0, 0.0, 1.0});
  GlobalAnswer all = global_.locate(points, here, {});
  const PlaceVerdict verdict = distant_.judge(all, fit.map_from_base, has_changed);
  if (verdict == PlaceVerdict::ChangedAndAlike) lose(reason::kChangedAndAlike.english);
  if (verdict == PlaceVerdict::Elsewhere) {
    filter_.place(fit.map_from_base, fit.covariance);  // the best guess until the place is found
    lose(reason::kMovedByHand.english, std::move(all));
  }
  return verdict != PlaceVerdict::Stands;
}

/// The vehicle is there, whatever was tracked before.
void WallTracker::place_at(const RegistrationResult& there) {
  filter_.place(there.map_from_base, there.covariance + variances(1e-3, 1e-3, 1e-4));
  distant_.expect(there.inlier_fraction);
  last_fit_.reset();
  scale_.start_at(there.map_from_base);
}

/// Where the building proves to be of another size than drawn, the vehicle is where the tracker of that size
/// has it.
void WallTracker::learn_scale(const ScanPoints& seen, const OdometryStep& step) {
  constexpr double kSigmaM = 0.05;
  constexpr double kSigmaRad = 0.01;
  if (!scale_.observe(seen, global_.grid(), step.motion)) return;
  filter_.place(scale_.best_pose(), variances(kSigmaM * kSigmaM, kSigmaM * kSigmaM, kSigmaRad * kSigmaRad));
  last_fit_.reset();
}

void WallTracker::correct(const RegistrationResult& fit, const OdometryStep& step) {
  const double floor_m2 = options_.scan_sigma_m * options_.scan_sigma_m;
  const double floor_rad2 = options_.scan_sigma_rad * options_.scan_sigma_rad;
  filter_.correct(fit.map_from_base, fit.covariance + variances(floor_m2, floor_m2, floor_rad2));
  if (last_fit_)
    model_.learn(step, last_fit_->inverse() * fit.map_from_base, 0.5 * options_.scan_sigma_m,
                 options_.scan_sigma_rad);
  last_fit_ = fit.map_from_base;
  distant_.learn(evidence_, step.motion);
  if (misses_ >= options_.misses_to_degrade) nearby_.reopen();
  misses_ = 0;
  unbroken_ = true;
  health_ = {LocalizationState::Localized, ""};
}

bool WallTracker::wheels_still_do() const {
  return unbroken_ && filter_.worst_variance_m2() < options_.wheels_alone_m * options_.wheels_alone_m &&
         filter_.yaw_variance_rad2() < options_.wheels_alone_rad * options_.wheels_alone_rad;
}

/// A scan that teaches nothing. `loses`: after so many the place counts as unknown.
void WallTracker::miss(const std::string& reason, bool loses) {
  last_fit_.reset();
  ++misses_;
  if (loses && misses_ >= options_.misses_to_lose)
    lose(reason);
  else if (misses_ >= options_.misses_to_degrade)
    health_ = {LocalizationState::Degraded, reason};
}

std::vector<PoseHypothesis> WallTracker::hypotheses() const {
  if (tracking_ || search_.is_given())
    return {{filter_.pose() * since_scan_.motion, 1.0, evidence_.explained}};
  return search_.hypotheses(since_scan_.motion);
}

}  // namespace madori::localization
