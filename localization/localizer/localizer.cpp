#include "localization/localizer/localizer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "localization/localizer/pose_covariance.hpp"
#include "localization/pose_axes.hpp"

namespace madori::localization {
Localizer::Localizer(const mapping::Walls& walls, const std::optional<InitialPose>& initial,
                     const LocalizerOptions& options)
    : options_(options), model_(options.odometry) {
  if (!walls.empty()) map_.drawing.emplace(walls);
  begin_anew(initial);
}

/// What was remembered lies elsewhere, or nobody knows where: a fresh memory, from the next scan on.
void Localizer::begin_anew(const std::optional<StartPrior>& told, bool carried) {
  worker_.discard();
  const bool was_sure = is_sure();
  if (map_.drawing && carried && was_sure)
    map_.drawing->set_earlier(std::make_shared<const Memory>(remembered()->together()));
  map_.memory = Memory(options_.memory);
  if (map_.drawing) {
    map_.drawing->belief.forget();
    if (started_ && !was_sure) map_.drawing->walls.straighten();   // what it was bent to may lie elsewhere
    if (started_ && !carried) map_.drawing->set_earlier(nullptr);  // a person knows better
  }
  map_.evidence = {};
  map_.evidence.has_drawing = map_.drawing.has_value();
  map_.told = map_.start = told;
  if (told && map_.drawing) {
    const BendingDrawing& walls = map_.drawing->walls;
    map_.start->map_from_base = walls.in_building(told->map_from_base);
    if (told->former) map_.start->former->map_from_base = walls.in_building(told->former->map_from_base);
  }
  map_.placed = told.has_value();
  map_.next_survey_walls = 0.0;
  map_.unconfirmed_size = 0;
  if (told) anchor_ = map_.start->map_from_base;
  const StartPrior sigma = told.value_or(StartPrior{{}, 1e2, kPi});
  covariance_ = Eigen::Vector3d(sigma.sigma_m * sigma.sigma_m, sigma.sigma_m * sigma.sigma_m,
                                sigma.sigma_rad * sigma.sigma_rad)
                    .asDiagonal();
  late_anchor_.reset();
  since_scan_ = {};
  if (!track_.empty()) anchor_stamp_ = track_.newest().stamp;
  started_ = false;
}

void Localizer::set_pose(const Transform2<Map, Base>& map_from_base, const PoseSigma& sigma) {
  StartPrior told{map_from_base, sigma.position_m, sigma.yaw_rad};
  if (map_.drawing && started_)
    told.former = {map_.drawing->walls.on_drawing(anchor_ * since_scan_.motion), map_.evidence.here};
  begin_anew(told);
}

void Localizer::search_anew() {
  begin_anew(std::nullopt);
}

std::vector<PoseHypothesis> Localizer::hypotheses() const {
  std::vector<PoseHypothesis> all;
  if (!map_.drawing) return all;
  const Transform2<Map, Base> here = anchor_ * since_scan_.motion;
  for (const Placement& p : map_.drawing->belief.placements())
    if (!p.mirrored)
      all.push_back({map_.drawing->walls.on_drawing(p.correction * here), p.probability, p.explained});
  return all;
}

PoseEstimate Localizer::estimate(Stamp stamp, const Transform2<Map, Base>& map_from_base) const {
  PoseEstimate estimate;
  estimate.stamp = stamp;
  estimate.map_from_base = map_from_base;
  estimate.moved = moved_;
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
  // Where much is new or moves, less than usual elsewhere is usual here.
  const double enough = std::min(options_.sure_inliers, options_.known_share * agreement_.usual_inliers());
  ScanMatch best = match_scan(scan, anchor_, step, enough, map_, options_);
  if (late_anchor_ && best.place.inlier_share < options_.sure_inliers) {
    ScanMatch late = match_scan(scan, *late_anchor_, step, enough, map_, options_);
    if (late.place.inlier_share > best.place.inlier_share) return late;
  }
  return best;
}

void Localizer::recall(Memory memory) {
  if (started_ || memory.empty()) return;
  if (map_.start)
    map_.memory = std::move(memory);
  else if (map_.drawing)
    map_.drawing->set_earlier(std::make_shared<const Memory>(std::move(memory))),
        map_.drawing->belief.exclude_mirror();
}

std::optional<RememberedParts> Localizer::remembered() const {
  if (!is_sure()) return std::nullopt;
  return RememberedParts{map_.memory, map_.drawing ? map_.drawing->earlier : nullptr};
}

void Localizer::start(const SurfaceScan& scan) {
  if (!track_.empty() && anchor_stamp_ < scan.stamp) {
    const Transform2<Base, Base> driven = track_.between(anchor_stamp_, scan.stamp, model_).motion;
    anchor_ = anchor_ * driven;
    for (auto* start : {&map_.told, &map_.start})
      if (*start) (*start)->carry(driven);
  }
  anchor_stamp_ = scan.stamp;
  agreement_.begin(scan.stamp);
  double way_m = 0.0;
  if (!map_.memory.empty()) {
    const std::optional<Transform2<Map, Base>> place = place_in_memory(scan, map_, options_);
    recalled_ = place.has_value();
    if (place) {
      anchor_ = *place;
      map_.start = StartPrior{map_.memory.poses().front(), options_.tie_m, options_.tie_rad};
      map_.told = map_.start;
      if (map_.drawing) map_.told->map_from_base = map_.drawing->walls.on_drawing(map_.start->map_from_base);
      way_m = options_.memory.break_open_m;  // unknown; the old keyframes are not recent
    } else {
      map_.memory = Memory(options_.memory);
    }
  }
  map_.memory.add(scan, way_m, anchor_, MeasuredMotion{});
  since_scan_ = {};
  since_keyframe_ = {};
  keyframes_since_thinking_ = 1;
  started_ = true;
}

/// The motion of a scan, as far as the recent keyframes tell it; else to where the whole memory, or the
/// wheels, put it.
void Localizer::go_on(const MatchResult& recent, const Transform2<Map, Base>& place,
                      const OdometryStep& step) {
  if (recent.inlier_share > options_.lost_inliers) {
    const Transform2<Base, Base> motion = anchor_.inverse() * recent.map_from_base;
    since_keyframe_.add_matched(motion, recent.information, recent.inlier_share);
    model_.learn(step, motion);
  } else {
    since_keyframe_.add_unmatched(anchor_.inverse() * place, recent.inlier_share);
  }
}

void Localizer::remember(const SurfaceScan& scan) {
  map_.memory.add(scan, since_keyframe_.path_m(), anchor_,
                  since_keyframe_.measured(map_.memory.poses().back()));
  since_keyframe_ = {};
  ++keyframes_since_thinking_;
}

void Localizer::think_if_due(Stamp stamp) {
  const std::size_t size = map_.memory.size();
  // One that was switched on with a large memory stands, too, and is not to move before it has looked.
  const bool at_once = !map_.evidence.looked || size < options_.young_size || agreement_.is_beside_walls();
  const int every = at_once ? 1 : size < 200 ? 4 : 8;
  if (!worker_.busy() && keyframes_since_thinking_ >= every) {
    keyframes_since_thinking_ = 0;
    worker_.start(stamp, map_, options_);
  }
}

/// What the worker found out moves the memory, and the vehicle with its newest part.
void Localizer::take_in_thoughts(Stamp stamp) {
  if (MapState* thought = worker_.take(stamp, thinking_, options_)) {
    const Transform2<Map, Map> by = map_.take_in(*thought, worker_.known());
    anchor_ = by * anchor_;
    moved_ = by * moved_;
    if (late_anchor_) late_anchor_ = by * *late_anchor_;
  }
}

Memory Localizer::finished_memory() {
  MapState state = map_;
  state.think(options_);
  return RememberedParts{std::move(state.memory), state.drawing ? state.drawing->earlier : nullptr}
      .together();
}

PoseEstimate Localizer::on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor) {
  weighty_points(points, weighty_);
  const SurfaceScan& scan = scanner_.make(stamp, sensor, weighty_, options_.scan);
  take_in_thoughts(stamp);
  if (started_ && stamp < anchor_stamp_) return on_late_scan(stamp, scan);
  if (started_) {
    const OdometryStep step = track_.between(anchor_stamp_, stamp, model_);
    const Transform2<Map, Base> before = anchor_;
    follow(scan, step);
    if (was_carried(stamp, points, step, before) || gives_up(stamp)) {
      begin_anew(std::nullopt, true);
      surroundings_.restart();
    }
  } else {
    surroundings_.take(stamp, points);
  }
  anchor_stamp_ = started_ ? stamp : anchor_stamp_;
  if (!started_ && !scan.points.empty())
    start(scan);
  else if (started_)
    remember_if_new(scan);
  since_scan_ = track_.since(stamp, model_);
  if (started_) think_if_due(stamp);
  return estimate(stamp, anchor_);
}

void Localizer::remember_if_new(const SurfaceScan& scan) {
  if (is_new_view(map_.memory.poses().back().inverse() * anchor_, options_)) return remember(scan);
  if (!wants_another_look(scan.stamp)) return;
  remember(scan);
  map_.next_survey_walls = 0.0;  // all places are looked at with it
}

/// Does the lidar see other surroundings than a moment ago, wherever the vehicle is laid, and does the memory
/// explain them less than usual?
bool Localizer::was_carried(Stamp stamp, const ScanPoints& points, const OdometryStep& step,
                            const Transform2<Map, Base>& before) {
  surroundings_.take(stamp, points);
  const bool others = surroundings_.compare(step.motion, before.inverse() * anchor_) == Surroundings::Others;
  return others && (surroundings_.followed_at_once() ||
                    map_.evidence.on_memory < options_.known_share * agreement_.usual_inliers());
}

/// Which of the two clocks is right shows next. It is answered only: what is known of the newest scan's place
/// is not known of this one's.
PoseEstimate Localizer::on_late_scan(Stamp stamp, const SurfaceScan& scan) {
  late_anchor_ = match(scan, OdometryStep{}).place.map_from_base;
  PoseEstimate late = estimate(stamp, *late_anchor_);
  if (late.health.state == LocalizationState::Localized)
    late.health = {LocalizationState::Degraded, "the scan is older than one before it: its place is a guess",
                   late.health.place};
  return late;
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
  go_on(recent, matched.map_from_base, step);
  anchor_ = matched.map_from_base;
  covariance_ = matched_covariance(matched, map_);
}

/// Has nothing agreed for so long that what is remembered must lie elsewhere?
bool Localizer::gives_up(Stamp stamp) const {
  return map_.drawing && map_.placed && map_.evidence.blind_scans >= options_.restart_scans &&
         judge(agreement_.evidence_at(stamp, map_.evidence), options_.health).state ==
             LocalizationState::Lost;
}

/// A vehicle that stands and does not know where sees the same for ever, but for noise and what moves before
/// its lidar. Its looks are one view, the better seen the more there are: a wall counts by its length. Each
/// for itself, it would in the end believe the one that chance had favour a wrong place.
bool Localizer::wants_another_look(Stamp stamp) const {
  return map_.drawing && !map_.placed && map_.evidence.looked && !worker_.busy() &&
         to_seconds(stamp - map_.memory.keyframes().back().scan->stamp) > options_.another_look_s;
}

}  // namespace madori::localization
