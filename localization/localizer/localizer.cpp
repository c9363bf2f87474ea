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
    : options_(options), model_(options.odometry) {
  map_.memory = Memory(options.memory);
  map_.start = initial.value_or(InitialPose{});
  map_.evidence.has_drawing = !walls.empty();
  anchor_ = map_.start.map_from_base;
  if (!walls.empty()) {
    map_.drawing.emplace(walls);
    map_.evidence.searching = !initial;
  }
}

HealthEvidence Localizer::evidence_with_time(Stamp stamp) const {
  HealthEvidence evidence = map_.evidence;
  if (evidence.blind_scans > 0) {
    evidence.blind_s = to_seconds(stamp - last_agreed_);
  }
  evidence.off_walls = wall_fit_.is_poor();
  return evidence;
}

bool Localizer::drawing_is_exact() const {
  return map_.drawing && map_.drawing->model().sigma_m < options_.exact_drawing_m;
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

Localizer::Match Localizer::match(const SurfaceScan& scan, const OdometryStep& step) const {
  Match best = match_from(anchor_, scan, step);
  if (late_anchor_ && best.place.inlier_share < options_.sure_inliers) {
    Match late = match_from(*late_anchor_, scan, step);
    if (late.place.inlier_share > best.place.inlier_share) return late;
  }
  return best;
}

Localizer::Match Localizer::match_from(const Transform2<Map, Base>& anchor, const SurfaceScan& scan,
                                       const OdometryStep& step) const {
  const Transform2<Map, Base> prediction = anchor * step.motion;
  const Eigen::Matrix3d covariance = with_floor(in_map_axes(step.covariance, anchor.yaw_rad()));
  const MatchPrior prior{prediction, covariance.inverse()};
  const LocalMap map = map_.memory.recent_map(prediction.translation());
  SearchWindow window;
  window.sigma_m = std::sqrt(std::max(covariance(0, 0), covariance(1, 1)));
  window.sigma_rad = std::sqrt(covariance(2, 2));
  window.half_m = std::clamp(3.0 * window.sigma_m, std::min(0.3, 0.15 + 2.0 * step.path_m), 1.0);
  window.half_rad = std::clamp(3.0 * window.sigma_rad, 0.05, 0.8);
  ExtraPull pull;
  if (drawing_is_exact()) {
    pull = [&](const Transform2<Map, Base>& pose, Eigen::Matrix3d& hessian, Eigen::Vector3d& gradient) {
      map_.drawing->pull(scan, pose, hessian, gradient);
    };
  }
  MatchResult near = map.refine(scan, map.search(scan, prediction, window).map_from_base, prior, pull);
  if (near.inlier_share > options_.sure_inliers) {
    return {near, near};
  }
  window.half_m = 0.5 + 0.5 * std::min(2.0, step.path_m);
  window.half_rad = 0.8;
  const LocalMap whole = map_.memory.whole_map(prediction.translation());
  MatchResult far = whole.refine(scan, whole.search(scan, prediction, window).map_from_base, prior, pull);
  // The farther from what the wheels say, the clearer the scan must speak.
  const Transform2<Base, Base> off = prediction.inverse() * far.map_from_base;
  const double metres = std::hypot(off.x_m(), off.y_m()) / window.sigma_m;
  const double turns = off.yaw_rad() / window.sigma_rad;
  const double margin = 0.05 + 0.03 * std::log1p(metres * metres + turns * turns);
  return {far.inlier_share > near.inlier_share + margin ? far : near, near};
}

void Localizer::recall(Memory memory) {
  if (started_ || map_.evidence.searching || memory.empty()) return;
  map_.memory = std::move(memory);
}

/// Where the first scan lies in a recalled memory, near the start pose.
std::optional<Transform2<Map, Base>> Localizer::place_in_memory(const SurfaceScan& scan) const {
  const InitialPose& start = map_.start;
  const LocalMap map = map_.memory.whole_map(start.map_from_base.translation());
  const SearchWindow window{2.0 * start.sigma_m, 2.0 * start.sigma_rad, start.sigma_m, start.sigma_rad};
  const MatchResult found = map.refine(scan, map.search(scan, start.map_from_base, window).map_from_base, {});
  return found.inlier_share > options_.sure_inliers ? std::optional(found.map_from_base) : std::nullopt;
}

void Localizer::start(SurfaceScan scan) {
  anchor_stamp_ = scan.stamp;
  last_agreed_ = scan.stamp;
  doubt_path_m_ = 0.0;
  double way_m = 0.0;
  if (!map_.memory.empty()) {
    const std::optional<Transform2<Map, Base>> place = place_in_memory(scan);
    recalled_ = place.has_value();
    if (place) {
      anchor_ = *place;
      map_.start = {map_.memory.poses().front(), 0.3, 0.1};  // the first keyframe is tied to it
      way_m = options_.memory.break_open_m;                  // unknown; the old keyframes are not recent
    } else {
      map_.memory = Memory(options_.memory);
    }
  }
  map_.memory.add(std::move(scan), way_m, anchor_, MeasuredMotion{});
  moved_ = {};
  moved_agreement_ = 1.0;
  since_scan_ = {};
  since_keyframe_ = {};
  keyframes_since_thinking_ = 1;
  started_ = true;
}

/// The motion of a scan, as far as the recent keyframes tell it; else the wheels', which may have slipped.
void Localizer::go_on(const MatchResult& recent, const OdometryStep& step) {
  moved_agreement_ = std::min(moved_agreement_, recent.inlier_share);
  if (recent.inlier_share > options_.lost_inliers) {
    moved_ = moved_ * (anchor_.inverse() * recent.map_from_base);
    moved_information_ = recent.information;
    model_.learn(step, anchor_.inverse() * recent.map_from_base, 0.02, 0.005);
    return;
  }
  moved_ = moved_ * step.motion;
  moved_information_.setZero();
  since_keyframe_.covariance += Eigen::Vector3d(0.04, 0.04, 0.25).asDiagonal();
}

void Localizer::remember(SurfaceScan scan) {
  const Transform2<Map, Base> last = map_.memory.poses().back();
  const Eigen::Matrix3d wheels = with_floor(since_keyframe_.covariance).inverse();
  const Eigen::Matrix3d seen = in_map_axes(moved_information_, -last.yaw_rad());
  map_.memory.add(std::move(scan), since_keyframe_.path_m, anchor_,
                  MeasuredMotion{moved_, seen + wheels, moved_agreement_});
  since_keyframe_ = {};
  moved_ = {};
  moved_agreement_ = 1.0;
  ++keyframes_since_thinking_;
}

void Localizer::think_if_due(Stamp stamp) {
  const std::size_t size = map_.memory.size();
  if (!worker_.busy() && keyframes_since_thinking_ >= (size < 20 || beside_walls_ ? 1 : size < 200 ? 4 : 8)) {
    keyframes_since_thinking_ = 0;
    worker_.start(stamp, map_, options_);
  }
}

/// What the worker found out moves the memory, and the vehicle with its newest part.
void Localizer::take_in_thoughts(Stamp stamp) {
  if (std::optional<MapState> thought = worker_.take(stamp, options_)) {
    const Transform2<Map, Map> by = map_.memory.take_in(std::move(thought->memory), worker_.known());
    thought->memory = std::move(map_.memory);
    thought->evidence.blind_scans = map_.evidence.blind_scans;
    thought->evidence.blind_m = map_.evidence.blind_m;
    thought->evidence.on_walls = map_.evidence.on_walls;
    thought->evidence.on_memory = map_.evidence.on_memory;
    map_ = *std::move(thought);
    anchor_ = by * anchor_;
    if (late_anchor_) late_anchor_ = by * *late_anchor_;
  }
}

/// Is the match far from where the wheels say?
bool Localizer::jumps(const MatchResult& match, const OdometryStep& step) const {
  const Transform2<Base, Base> off = (anchor_ * step.motion).inverse() * match.map_from_base;
  const Eigen::Matrix3d covariance = with_floor(step.covariance);
  const Eigen::Vector3d e(off.x_m(), off.y_m(), off.yaw_rad());
  return e.dot(covariance.inverse() * e) > 16.0;
}

/// Does the scan lie, where it was matched, on what was remembered before the doubt began? Then the vehicle
/// has not been carried off, drawn walls or not.
bool Localizer::is_known_from_before(const SurfaceScan& scan, const MatchResult& match) const {
  const Point2<Map> here = match.map_from_base.translation();
  const LocalMap before = map_.memory.whole_map(here, doubt_path_m_);
  if (before.empty()) return false;
  const MatchResult again = before.refine(scan, match.map_from_base, {});
  return again.inlier_share > std::max(options_.lost_inliers, options_.known_share * usual_inliers_) &&
         distance_m(again.map_from_base.translation(), here) < options_.same_place_m;
}

/// Does the scan agree with the memory as scans usually do here? Furniture and people hide walls: that the
/// drawing does not show what is seen is no reason for doubt while memory and wheels go on. Once in doubt,
/// the memory alone does not clear it: what was added since the doubt began agrees with itself anywhere.
void Localizer::note_agreement(const SurfaceScan& scan, const MatchResult& match, const OdometryStep& step) {
  const bool drawing_speaks = map_.drawing && !map_.evidence.searching && map_.drawing_fits(options_.health);
  const double on_walls = drawing_speaks ? map_.drawing->share_on_walls(scan, match.map_from_base) : 0.0;
  const bool exact = drawing_speaks && drawing_is_exact();
  if (drawing_speaks) wall_fit_.add(on_walls, step.path_m, step.turned_rad);
  beside_walls_ = drawing_speaks && on_walls < 0.5 * wall_fit_.usual();
  map_.evidence.on_walls = on_walls;
  map_.evidence.on_memory = match.inlier_share;
  bool agrees = match.inlier_share > std::max(options_.lost_inliers, 0.5 * usual_inliers_);
  if (exact && (map_.evidence.blind_scans > 0 || jumps(match, step))) {
    agrees = agrees && (on_walls > 0.5 * wall_fit_.usual() || is_known_from_before(scan, match));
  }
  if (!agrees) {
    ++map_.evidence.blind_scans;
    map_.evidence.blind_m += step.path_m;
    return;
  }
  usual_inliers_ += 0.05 * (match.inlier_share - usual_inliers_);
  last_agreed_ = scan.stamp;
  doubt_path_m_ = map_.memory.keyframes().back().path_m;
  map_.evidence.blind_scans = 0;
  map_.evidence.blind_m = 0.0;
}

/// What the scan says, and what the drawing's own error adds: walls that are drawn wrong lead all alike.
void Localizer::update_covariance(const MatchResult& match) {
  const Eigen::Matrix3d floor = Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();
  covariance_ = (match.information + Eigen::Matrix3d::Identity()).inverse() + floor;
  if (map_.drawing && map_.evidence.walls_seen > 0.0) {
    const double share = map_.drawing->model().sigma_m * map_.drawing->model().sigma_m;
    const double walls = std::max(1.0, 0.1 * map_.evidence.inliers * map_.evidence.walls_seen);
    covariance_.diagonal() += Eigen::Vector3d(share, share, 0.01 * share) * (1.0 + 4.0 / walls) * 0.5;
  }
}

Memory Localizer::finished_memory() {
  MapState state = map_;
  state.think(options_);
  return std::move(state.memory);
}

/// After being moved by hand: what was remembered lies elsewhere; the place is sought with a fresh memory.
void Localizer::search_from_here(SurfaceScan scan) {
  worker_.discard();
  map_.memory = Memory(options_.memory);
  map_.evidence = {};
  map_.evidence.searching = true;
  map_.next_survey_walls = 0.0;
  wall_fit_ = WallFit();
  start(std::move(scan));
}

PoseEstimate Localizer::on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor) {
  SurfaceScan scan = make_surface_scan(stamp, sensor, to_points(points), options_.scan);
  if (!started_) {
    if (!scan.points.empty()) {
      start(std::move(scan));
      think_if_due(stamp);
    }
    return estimate(stamp, anchor_);
  }
  take_in_thoughts(stamp);
  if (stamp < anchor_stamp_) {
    late_anchor_ =
        match(scan, OdometryStep{}).place.map_from_base;  // which of the two clocks is right shows next
    return estimate(stamp, *late_anchor_);
  }
  const OdometryStep step = track_.between(anchor_stamp_, stamp, model_);
  auto [matched, recent] = match(scan, step);
  late_anchor_.reset();
  note_agreement(scan, matched, step);
  const bool fits = matched.inlier_share > options_.lost_inliers;
  if (!fits) {
    matched.map_from_base = anchor_ * step.motion;
    matched.information.setZero();
    map_.memory.note_break();
  }
  go_on(recent, step);
  anchor_ = matched.map_from_base;
  anchor_stamp_ = stamp;
  update_covariance(matched);
  since_scan_ = track_.empty() ? OdometryStep{} : track_.between(stamp, track_.newest().stamp, model_);
  if (drawing_is_exact() && !map_.evidence.searching && map_.evidence.blind_scans >= options_.restart_scans &&
      judge(evidence_with_time(stamp), options_.health).state == LocalizationState::Lost &&
      map_.drawing_fits(options_.health)) {
    search_from_here(std::move(scan));
    return estimate(stamp, anchor_);
  }
  const Transform2<Base, Base> moved = map_.memory.poses().back().inverse() * anchor_;
  if (std::hypot(moved.x_m(), moved.y_m()) > options_.keyframe_m ||
      std::abs(moved.yaw_rad()) > options_.keyframe_rad) {
    remember(std::move(scan));
  }
  think_if_due(stamp);
  return estimate(stamp, anchor_);
}

}  // namespace madori::localization
