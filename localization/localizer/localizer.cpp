#include "localization/localizer/localizer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "localization/localizer/pose_covariance.hpp"

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

PoseEstimate Localizer::estimate(Stamp stamp, const Transform2<Map, Base>& map_from_base) const {
  PoseEstimate estimate;
  estimate.stamp = stamp;
  estimate.map_from_base = map_from_base;
  estimate.covariance = covariance_ + in_map_axes(since_scan_.covariance, anchor_.yaw_rad());
  HealthEvidence evidence = agreement_.evidence_at(stamp, map_.evidence);
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
  since_keyframe_.extend(raw, model_);
  return estimate(reading.stamp, anchor_ * since_scan_.motion);
}

/// Once a scan's stamp ran backwards, the vehicle may be where that one put it, too.
ScanMatch Localizer::match(const SurfaceScan& scan, const OdometryStep& step) const {
  ScanMatch best = match_scan(scan, anchor_, step, map_, options_);
  if (late_anchor_ && best.place.inlier_share < options_.sure_inliers) {
    ScanMatch late = match_scan(scan, *late_anchor_, step, map_, options_);
    if (late.place.inlier_share > best.place.inlier_share) return late;
  }
  return best;
}

void Localizer::recall(Memory memory) {
  if (started_ || map_.evidence.searching || memory.empty()) return;
  map_.memory = std::move(memory);
}

void Localizer::start(SurfaceScan scan) {
  anchor_stamp_ = scan.stamp;
  agreement_.begin(scan.stamp);
  double way_m = 0.0;
  if (!map_.memory.empty()) {
    const std::optional<Transform2<Map, Base>> place = place_in_memory(scan, map_, options_);
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
  since_scan_ = {};
  since_keyframe_ = {};
  keyframes_since_thinking_ = 1;
  started_ = true;
}

/// The motion of a scan, as far as the recent keyframes tell it; else the wheels'.
void Localizer::go_on(const MatchResult& recent, const OdometryStep& step) {
  if (recent.inlier_share > options_.lost_inliers) {
    const Transform2<Base, Base> motion = anchor_.inverse() * recent.map_from_base;
    since_keyframe_.add_matched(motion, recent.information, recent.inlier_share);
    model_.learn(step, motion, 0.02, 0.005);
  } else {
    since_keyframe_.add_unmatched(step.motion, recent.inlier_share);
  }
}

void Localizer::remember(SurfaceScan scan) {
  map_.memory.add(std::move(scan), since_keyframe_.path_m(), anchor_,
                  since_keyframe_.measured(map_.memory.poses().back()));
  since_keyframe_ = {};
  ++keyframes_since_thinking_;
}

void Localizer::think_if_due(Stamp stamp) {
  const std::size_t size = map_.memory.size();
  const int every = size < 20 || agreement_.is_beside_walls() ? 1 : size < 200 ? 4 : 8;
  if (!worker_.busy() && keyframes_since_thinking_ >= every) {
    keyframes_since_thinking_ = 0;
    worker_.start(stamp, map_, options_);
  }
}

/// What the worker found out moves the memory, and the vehicle with its newest part.
void Localizer::take_in_thoughts(Stamp stamp) {
  if (std::optional<MapState> thought = worker_.take(stamp, options_)) {
    const Transform2<Map, Map> by = map_.take_in(*std::move(thought), worker_.known());
    anchor_ = by * anchor_;
    if (late_anchor_) late_anchor_ = by * *late_anchor_;
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
  if (stamp < anchor_stamp_) return on_late_scan(stamp, scan);
  follow(scan, track_.between(anchor_stamp_, stamp, model_));
  anchor_stamp_ = stamp;
  since_scan_ = track_.empty() ? OdometryStep{} : track_.between(stamp, track_.newest().stamp, model_);
  if (gives_up(stamp)) {
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

/// Which of the two clocks is right shows next.
PoseEstimate Localizer::on_late_scan(Stamp stamp, const SurfaceScan& scan) {
  late_anchor_ = match(scan, OdometryStep{}).place.map_from_base;
  return estimate(stamp, *late_anchor_);
}

/// The vehicle moves to where the scan lies, or, where that is nowhere, as the wheels say.
void Localizer::follow(const SurfaceScan& scan, const OdometryStep& step) {
  auto [matched, recent] = match(scan, step);
  late_anchor_.reset();
  const Transform2<Map, Base> prediction = anchor_ * step.motion;
  agreement_.note(scan, matched, prediction, step, map_, options_);
  if (!(matched.inlier_share > options_.lost_inliers)) {
    matched.map_from_base = prediction;
    matched.information.setZero();
    map_.memory.note_break();
  }
  go_on(recent, step);
  anchor_ = matched.map_from_base;
  covariance_ = matched_covariance(matched, map_);
}

/// Was the vehicle moved by hand, so that what is remembered lies elsewhere? Only an exact drawing that had
/// fitted is better than the memory.
bool Localizer::gives_up(Stamp stamp) const {
  return map_.drawing_is_exact(options_) && !map_.evidence.searching &&
         map_.evidence.blind_scans >= options_.restart_scans &&
         judge(agreement_.evidence_at(stamp, map_.evidence), options_.health).state ==
             LocalizationState::Lost &&
         map_.drawing_fits(options_.health);
}

}  // namespace madori::localization
