#include "localization/wall_tracker/wall_tracker.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "localization/health/reasons.hpp"
#include "localization/particle_filter/beam_path.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

constexpr double kSamePlaceM = 0.3;
constexpr double kSamePlaceRad = 0.1;

bool is_same_place(const Pose& a, const Pose& b) {
  return distance_m(a.translation(), b.translation()) < kSamePlaceM &&
         std::abs(wrap_angle(a.yaw_rad() - b.yaw_rad())) < kSamePlaceRad;
}

/// The covariance of `from * step`, Map axes.
Eigen::Matrix3d carried(const Eigen::Matrix3d& covariance, const Pose& from, const OdometryStep& step) {
  const Pose to = from * step.motion;
  Eigen::Matrix3d carry = Eigen::Matrix3d::Identity();
  carry(0, 2) = -(to.y_m() - from.y_m());
  carry(1, 2) = to.x_m() - from.x_m();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn(0, 0) = turn(1, 1) = from.cos_yaw();
  turn(0, 1) = -from.sin_yaw();
  turn(1, 0) = from.sin_yaw();
  return carry * covariance * carry.transpose() + turn * step.covariance * turn.transpose();
}

/// Starts for registration within two sigma of a given pose: half a metre and ten degrees apart, so that each
/// pose between them is drawn to the same walls.
std::vector<Pose> around(const Pose& given, const PoseSigma& sigma) {
  constexpr double kStepM = 0.5;
  constexpr double kStepRad = 0.17;
  constexpr double kMost = 6.0;
  const double reach_m = std::min(2.0 * sigma.position_m, kMost * kStepM);
  const double reach_rad = std::min(2.0 * sigma.yaw_rad, kPi);
  const int n = static_cast<int>(std::ceil(reach_m / kStepM));
  const int turns = static_cast<int>(std::ceil(reach_rad / kStepRad));
  std::vector<Pose> starts;
  for (int i = -n; i <= n; ++i)
    for (int j = -n; j <= n; ++j)
      for (int k = -turns; k <= turns; ++k)
        if (i * i + j * j <= n * n)
          starts.emplace_back(given.x_m() + i * reach_m / n, given.y_m() + j * reach_m / n,
                              given.yaw_rad() + k * reach_rad / turns);
  return starts;
}

/// The hypothesis of the answer that lies at `pose`; null when it has none there.
const Hypothesis* at(const GlobalAnswer& answer, const Pose& pose) {
  const auto found =
      std::find_if(answer.hypotheses.begin(), answer.hypotheses.end(),
                   [&](const Hypothesis& h) { return is_same_place(h.fit.map_from_base, pose); });
  return found == answer.hypotheses.end() ? nullptr : &*found;
}

/// By how many nats the best place elsewhere leads the one at `pose`, of which `unfit` stands where the
/// answer does not know it.
double lead_of_elsewhere(const GlobalAnswer& answer, const Pose& pose, double unfit) {
  const Hypothesis* tracked = at(answer, pose);
  if (tracked == nullptr) return unfit;
  const auto& all = answer.hypotheses;
  const auto rival = std::find_if(all.begin(), all.end(), [&](const Hypothesis& h) { return &h != tracked; });
  return rival == all.end() ? -1e3 : rival->log_likelihood - tracked->log_likelihood;
}

}  // namespace

WallTracker::WallTracker(const mapping::Walls& walls, const WallTrackerOptions& options)
    : options_(options), global_(walls), model_(options.odometry) {}

PoseEstimate WallTracker::estimate(Stamp stamp) const {
  return {stamp, anchor_ * since_scan_.motion, carried(covariance_, anchor_, since_scan_), health_};
}

PoseEstimate WallTracker::on_odometry(const OdometryReading& reading) {
  const OdometryReading before = track_.empty() ? reading : track_.newest();
  if (track_.add(reading))
    model_.extend(since_scan_, before.odom_from_base.inverse() * reading.odom_from_base);
  return estimate(reading.stamp);
}

PoseEstimate WallTracker::on_scan(Stamp stamp, const ScanPoints& seen) {
  if (stamp < anchor_stamp_ && !given_) return estimate(stamp);
  const ScanPoints points = scale_.applied(seen);
  const OdometryStep step = track_.between(anchor_stamp_, stamp, model_);
  const Eigen::Matrix3d grown = carried(covariance_, anchor_, step);
  if (stamp - anchor_stamp_ > RecentView::kRecent) {
    unbroken_ = false;
    settled_ = 0;
    settled_m_ = 0.0;
  }
  evidence_ = {};
  view_.take(stamp, points);
  if (given_ || !tracking_) anchor_ = anchor_ * step.motion;
  covariance_ = grown;
  if (given_)
    check_given(points);
  else if (tracking_)
    track(points, step);
  else
    search(points, step.motion);
  if (tracking_)
    if (const auto there = nearby_.observe(points, global_.grid(), anchor_, step.motion)) place_at(*there);
  if (tracking_) learn_scale(seen, step);
  anchor_stamp_ = stamp;
  since_scan_ = track_.empty() ? OdometryStep{} : track_.between(stamp, track_.newest().stamp, model_);
  return {stamp, anchor_, covariance_, health_};
}

void WallTracker::set_pose(const Pose& map_from_base, const PoseSigma& sigma) {
  search_anew();
  given_ = sigma;
  anchor_ = map_from_base;
  anchor_stamp_ = track_.empty() ? anchor_stamp_ : track_.newest().stamp;
  since_scan_ = {};
  const double m2 = sigma.position_m * sigma.position_m;
  covariance_ = Eigen::Vector3d(m2, m2, sigma.yaw_rad * sigma.yaw_rad).asDiagonal();
  health_.reason = reason::kComparing.english;
}

void WallTracker::search_anew() {
  lose(reason::kSearching.english, std::nullopt);
}

void WallTracker::lose(const std::string& reason, std::optional<GlobalAnswer> answer) {
  tracking_ = false;
  scale_.lose();
  given_.reset();
  answer_ = std::move(answer);
  agreeing_ = misses_ = rivals_ = calm_ = settled_ = 0;
  settled_m_ = 0.0;
  covariance_ = Eigen::Matrix3d::Identity() * 1e4;
  health_ = {LocalizationState::Lost, reason};
}

void WallTracker::check_given(const ScanPoints& points) {
  GlobalAnswer answer = global_.judge(points, around(anchor_, *given_));
  given_.reset();
  if (answer.state == GlobalState::Found) return start_at(answer.hypotheses.front().fit, points);
  health_ = {answer.state == GlobalState::Ambiguous ? LocalizationState::Ambiguous : LocalizationState::Lost,
             reason::kGivenRefuted.english + answer.reason};
  answer_ = std::move(answer);
}

void WallTracker::search(const ScanPoints& points, const Transform2<Base, Base>& moved) {
  if (fall_of_view(moved, moved) > options_.carried_fall) answer_.reset();
  GlobalAnswer answer = answer_ ? global_.locate(points, *answer_, moved) : global_.locate(points);
  const bool found = answer.state == GlobalState::Found;
  const bool agrees = found && answer_ && answer_->state == GlobalState::Found &&
                      is_same_place(answer.hypotheses.front().fit.map_from_base,
                                    answer_->hypotheses.front().fit.map_from_base * moved);
  agreeing_ = found ? (agrees ? agreeing_ + 1 : 1) : 0;
  health_ = {answer.state == GlobalState::Ambiguous ? LocalizationState::Ambiguous : LocalizationState::Lost,
             found ? reason::kOnceMore.english : answer.reason};
  if (agreeing_ >= options_.sightings_to_start) return start_at(answer.hypotheses.front().fit, points);
  answer_ = std::move(answer);
}

void WallTracker::start_at(const RegistrationResult& found, const ScanPoints& points) {
  const RegistrationResult fit = nearby_.begin(points, global_.grid(), found);
  place_at(fit);
  tracking_ = true;
  misses_ = agreeing_ = rivals_ = calm_ = settled_ = 0;
  settled_m_ = 0.0;
  unbroken_ = true;
  usual_through_ = 0.0;
  evidence_.explained = fit.inlier_fraction;
  health_ = {LocalizationState::Localized, ""};
  answer_.reset();
}

void WallTracker::track(const ScanPoints& points, const OdometryStep& step) {
  constexpr std::size_t kFewest = 20;
  const Pose before = anchor_;
  const Pose predicted = before * step.motion;
  anchor_ = predicted;
  if (points.size() < kFewest) return miss(reason::kSeesNothing.english, true);
  const RegistrationResult fit = segment_icp(points, global_.grid(), predicted, options_.icp);
  evidence_.explained = fit.inlier_fraction;
  evidence_.through_walls = share_through_walls(points, global_.distance_field(), fit.map_from_base);
  evidence_.nearby_nats = global_.lead_of_nearby(points, fit.map_from_base);
  evidence_.correction_m = distance_m(fit.map_from_base.translation(), predicted.translation());
  evidence_.correction_rad = std::abs(wrap_angle(fit.map_from_base.yaw_rad() - predicted.yaw_rad()));
  const bool far_off = evidence_.correction_m > options_.most_correction_m ||
                       evidence_.correction_rad > options_.most_correction_rad;
  const double fall = fall_of_view(step.motion, far_off ? step.motion : before.inverse() * fit.map_from_base);
  if (fall > options_.carried_fall) return lose(reason::kOtherSurroundings.english, std::nullopt);
  const bool has_changed = fall > std::max(options_.changed_fall, options_.changed_spreads * view_.spread());
  calm_ = std::max(0, calm_ - 1);
  since_rival_m_ += std::hypot(step.motion.x_m(), step.motion.y_m());
  const bool looks = calm_ == 0 && (!is_settled() || since_rival_m_ >= options_.settled_every_m);
  if (has_changed || ((is_doubtful() || far_off) && looks)) {
    if (is_contradicted(points, fit, has_changed)) return;
  }
  if (fit.inlier_fraction < options_.sure_inliers)
    miss(reason::kLittleDrawn.english, !wheels_still_do());
  else if (far_off)
    miss(reason::kWallsAndWheels.english, true);
  else
    correct(fit, step);
}

/// By how much less than usual the scan has in common with the one before, taken from where the wheels or
/// from where the walls say.
double WallTracker::fall_of_view(const Transform2<Base, Base>& by_wheels,
                                 const Transform2<Base, Base>& by_walls) {
  evidence_.kept = view_.kept(by_wheels);
  if (view_.fall(evidence_.kept) > options_.changed_fall)
    evidence_.kept = std::max(evidence_.kept, view_.kept(by_walls));
  const double fall = view_.fall(evidence_.kept);
  if (fall <= options_.carried_fall) view_.learn(evidence_.kept);
  return fall;
}

bool WallTracker::is_doubtful() const {
  return evidence_.explained < usual_explained_ - options_.doubt_fall ||
         evidence_.explained < options_.sure_inliers ||
         evidence_.through_walls > usual_through_ + options_.doubt_through ||
         evidence_.nearby_nats > options_.doubt_nats;
}

bool WallTracker::is_settled() const {
  return settled_ >= options_.scans_to_settle && settled_m_ >= options_.metres_to_settle;
}

/// Looks at all places. True where the vehicle is lost by it: another place suits the scan clearly better
/// than the tracked one, for the second time; or it suits it about as well, and what is seen has just changed
/// as it would if the vehicle had been carried there.
bool WallTracker::is_contradicted(const ScanPoints& points, const RegistrationResult& fit, bool has_changed) {
  evidence_.looked_elsewhere = true;
  GlobalAnswer here;
  here.hypotheses.push_back({fit, 0.0, 0.0, 1.0});
  GlobalAnswer all = global_.locate(points, here, {});
  since_rival_m_ = 0.0;
  if (has_changed) settled_ = 0;
  const bool settled = is_settled();
  const double enough = settled ? options_.settled_nats : options_.rival_nats;
  const double lead = lead_of_elsewhere(all, fit.map_from_base, enough);
  if (has_changed && lead > -options_.twin_nats) {
    lose(reason::kChangedAndAlike.english, std::nullopt);
    return true;
  }
  if (lead < enough) {
    rivals_ = 0;
    calm_ = options_.calm_scans;
    return false;
  }
  if (++rivals_ < (settled ? options_.settled_rivals : options_.rivals_to_lose)) return false;
  lose(reason::kMovedByHand.english, std::move(all));
  anchor_ = fit.map_from_base;
  return true;
}

/// The vehicle is there, whatever was tracked before.
void WallTracker::place_at(const RegistrationResult& there) {
  anchor_ = there.map_from_base;
  covariance_ = there.covariance + Eigen::Matrix3d(Eigen::Vector3d(1e-3, 1e-3, 1e-4).asDiagonal());
  usual_explained_ = there.inlier_fraction;
  last_fit_.reset();
  scale_.start_at(anchor_);
}

/// Where the building proves to be of another size than drawn, the vehicle is where the tracker of that size
/// has it.
void WallTracker::learn_scale(const ScanPoints& seen, const OdometryStep& step) {
  constexpr double kSigmaM = 0.05;
  constexpr double kSigmaRad = 0.01;
  if (!scale_.observe(seen, global_.grid(), step.motion)) return;
  anchor_ = scale_.best_pose();
  covariance_ = Eigen::Vector3d(kSigmaM * kSigmaM, kSigmaM * kSigmaM, kSigmaRad * kSigmaRad).asDiagonal();
  last_fit_.reset();
}

void WallTracker::correct(const RegistrationResult& fit, const OdometryStep& step) {
  const Pose predicted = anchor_;
  const double floor_m2 = options_.scan_sigma_m * options_.scan_sigma_m;
  const double floor_rad2 = options_.scan_sigma_rad * options_.scan_sigma_rad;
  const Eigen::Matrix3d measured =
      fit.covariance + Eigen::Matrix3d(Eigen::Vector3d(floor_m2, floor_m2, floor_rad2).asDiagonal());
  const Eigen::Matrix3d gain = covariance_ * (covariance_ + measured).inverse();
  const Eigen::Vector3d innovation(fit.map_from_base.x_m() - predicted.x_m(),
                                   fit.map_from_base.y_m() - predicted.y_m(),
                                   wrap_angle(fit.map_from_base.yaw_rad() - predicted.yaw_rad()));
  const Eigen::Vector3d by = gain * innovation;
  anchor_ = {predicted.x_m() + by.x(), predicted.y_m() + by.y(), predicted.yaw_rad() + by.z()};
  covariance_ = (Eigen::Matrix3d::Identity() - gain) * covariance_;
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
  if (last_fit_)
    model_.learn(step, last_fit_->inverse() * fit.map_from_base, 0.5 * options_.scan_sigma_m,
                 options_.scan_sigma_rad);
  last_fit_ = fit.map_from_base;
  constexpr double kUsual = 0.1;
  usual_explained_ += kUsual * (evidence_.explained - usual_explained_);
  usual_through_ += kUsual * (evidence_.through_walls - usual_through_);
  if (misses_ >= options_.misses_to_degrade) nearby_.reopen();
  misses_ = 0;
  unbroken_ = true;
  ++settled_;
  settled_m_ += std::hypot(step.motion.x_m(), step.motion.y_m());
  if (!is_doubtful()) rivals_ = 0;
  health_ = {LocalizationState::Localized, ""};
}

bool WallTracker::wheels_still_do() const {
  const double middle = 0.5 * (covariance_(0, 0) + covariance_(1, 1));
  const double larger = middle + std::hypot(0.5 * (covariance_(0, 0) - covariance_(1, 1)), covariance_(0, 1));
  return unbroken_ && larger < options_.wheels_alone_m * options_.wheels_alone_m &&
         covariance_(2, 2) < options_.wheels_alone_rad * options_.wheels_alone_rad;
}

/// A scan that teaches nothing. `loses`: after so many the place counts as unknown.
void WallTracker::miss(const std::string& reason, bool loses) {
  last_fit_.reset();
  ++misses_;
  if (loses && misses_ >= options_.misses_to_lose)
    lose(reason, std::nullopt);
  else if (misses_ >= options_.misses_to_degrade)
    health_ = {LocalizationState::Degraded, reason};
}

std::vector<PoseHypothesis> WallTracker::hypotheses() const {
  constexpr std::size_t kMost = 10;
  constexpr double kLeastProbability = 1e-3;
  if (given_ || tracking_) return {{anchor_ * since_scan_.motion, 1.0, evidence_.explained}};
  std::vector<PoseHypothesis> list;
  if (!answer_) return list;
  for (const auto& h : answer_->hypotheses)
    if (list.size() < kMost && h.probability >= kLeastProbability)
      list.push_back({h.fit.map_from_base * since_scan_.motion, h.probability, h.fit.inlier_fraction});
  return list;
}

}  // namespace madori::localization
