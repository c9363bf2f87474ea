#include "localization/slam/graph_mapper.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "localization/localizer/pose_covariance.hpp"
#include "localization/memory/local_map.hpp"
#include "localization/pose_axes.hpp"
#include "localization/slam/final_fit.hpp"
#include "localization/slam/grid_match.hpp"

namespace madori::localization {
namespace {

/// By how much a motion that was measured otherwise is off the wheels' word.
double sigmas_squared(const OdometryStep& step, const Transform2<Base, Base>& motion,
                      const JointOptions& options) {
  const Eigen::Vector3d e = pose_difference(motion, step.motion);
  return e.dot(wheels_covariance(step, options).inverse() * e);
}

/// The piece of most keyframes, `of` having the piece of each; of several the oldest.
std::size_t largest_piece(const std::vector<std::size_t>& of) {
  std::map<std::size_t, std::size_t> sizes;
  for (const std::size_t piece : of) ++sizes[piece];
  return std::max_element(sizes.begin(), sizes.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

}  // namespace

GraphMapper::GraphMapper(const LocalizerOptions& options) : options_(options), follower_(options) {
  map_.memory = Memory(options.memory);
}

PoseEstimate GraphMapper::estimate(Stamp stamp) const {
  PoseEstimate estimate;
  estimate.stamp = stamp;
  estimate.map_from_base = shown_from_memory_ * anchor_ * follower_.since_scan().motion;
  estimate.covariance = covariance_ + in_map_axes(follower_.since_scan().covariance, anchor_.yaw_rad());
  estimate.health.state = is_apart_ ? LocalizationState::Lost : state_;
  return estimate;
}

PoseEstimate GraphMapper::on_odometry(const OdometryReading& reading) {
  follower_.on_odometry(reading);
  return estimate(reading.stamp);
}

void GraphMapper::follow(const SurfaceScan& scan) {
  auto [place, found, motion, is_known, wheels] = follower_.follow(scan, anchor_, map_);
  if (is_known) off_wheels_ = std::max(off_wheels_, sigmas_squared(wheels, motion, joints_));
  if (!found) {
    place.map_from_base = anchor_ * wheels.motion;
    place.information.setZero();
    map_.memory.note_break();
  }
  state_ = found ? LocalizationState::Localized : LocalizationState::Degraded;
  reckoned_.push_back({scan.stamp, reckoned_.back().odom_from_base * motion});
  anchor_ = place.map_from_base;
  covariance_ = matched_covariance(place, map_);
}

void GraphMapper::remember(const SurfaceScan& scan) {
  map_.memory.add(scan, follower_.since_keyframe().path_m(), anchor_,
                  map_.memory.empty() ? MeasuredMotion{}
                                      : follower_.since_keyframe().measured(map_.memory.poses().back()));
  wheels_at_.push_back(follower_.since_keyframe().wheels());
  follower_.begin_keyframe();
  off_wheels_at_.push_back(std::exchange(off_wheels_, 0.0));
  scan_of_.push_back(reckoned_.size() - 1);
}

/// A joint is judged when some keyframes stand on either side of it.
void GraphMapper::judge_joints(std::size_t until) {
  for (; judged_ < until; ++judged_) {
    const auto [joint, motion] =
        judge_joint(map_.memory, judged_, wheels_at_[judged_], off_wheels_at_[judged_], joints_);
    if (joint == Joint::Otherwise) lead_otherwise(judged_, motion);
    if (joint == Joint::False) cut(judged_);
  }
}

void GraphMapper::lead_otherwise(std::size_t first, const RelativeFactor& motion) {
  Memory& memory = map_.memory;
  const Transform2<Map, Base> newest = memory.poses().back();
  memory.lead_otherwise(first, motion);
  anchor_ = memory.poses().back() * newest.inverse() * anchor_;
}

void GraphMapper::cut(std::size_t first) {
  constexpr double kApartM = 10000.0;
  Memory& memory = map_.memory;
  const std::size_t piece = memory.pieces().back();
  const Transform2<Map, Map> by(kApartM * static_cast<double>(++cuts_), 0.0, 0.0);
  finder_.note_cut(first, memory.poses()[first - 1].inverse() * memory.poses()[first]);
  memory.cut(first);
  memory.move(by, first);
  anchor_ = by * anchor_;
  shown_from_piece_[first] = shown_from_piece_[piece] * by.inverse();
  note_piece();
}

void GraphMapper::note_piece() {
  const std::vector<std::size_t> of = map_.memory.pieces();
  is_apart_ = of.back() != largest_piece(of);
  shown_from_memory_ = shown_from_piece_[of.back()];
}

void GraphMapper::close_loops(bool at_end) {
  Memory& memory = map_.memory;
  const Transform2<Map, Base> newest = memory.poses().back();
  bool changed = memory.close_loops([this](const Memory& m, const RelativeFactor& loop) {
    return is_seen_alike(m, loop, finder_.options().stretch);
  }) > 0;
  if (changed) memory.optimise({});
  for (auto groups = finder_.look(memory, at_end); !groups.empty(); groups = finder_.look(memory, at_end)) {
    for (const auto& loops : groups) tie(loops);
    changed = true;
  }
  if (!changed) return;
  anchor_ = memory.poses().back() * newest.inverse() * anchor_;
  note_piece();
}

/// Pieces are brought to each other before the graph is solved; a loop that is far from closed pulls little
/// at first if it is to pull like all others at last.
void GraphMapper::tie(const std::vector<RelativeFactor>& loops) {
  Memory& memory = map_.memory;
  const std::vector<std::size_t> of = memory.pieces();
  const auto from = static_cast<std::size_t>(loops.front().from);
  const auto to = static_cast<std::size_t>(loops.front().to);
  if (of[from] != of[to]) {
    const Transform2<Map, Base> there = memory.poses()[from] * loops.front().motion;
    const Transform2<Map, Map> by = there * memory.poses()[to].inverse();
    if (of[from] < of[to]) {
      memory.move_piece(by, of[to]);
    } else {
      memory.move_piece(by.inverse(), of[from]);
    }
  }
  memory.tie(loops);
  for (const double loss : {100.0, 10.0, GraphOptions().loop_loss}) {
    GraphOptions options;
    options.loop_loss = loss;
    options.max_iterations = 20;
    memory.optimise({}, options);
  }
}

/// Does the scan, where it was matched, contradict what was seen last?
bool GraphMapper::sees_through_newest(const SurfaceScan& scan) const {
  const Transform2<Base, Base> motion = anchor_.inverse() * map_.memory.poses().back();
  const SightCount sights = sights_of_each_other(scan, *map_.memory.keyframes().back().scan, motion);
  return sights.both() >= joints_.least_seen && sights.contradiction() > joints_.most_through;
}

PoseEstimate GraphMapper::on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor) {
  SurfaceScanOptions how = options_.scan;
  how.noise_m = noise_.after(scan_noise_m(points));
  SurfaceScan scan = make_surface_scan(stamp, sensor, weighty_points(points), how);
  Memory& memory = map_.memory;
  if (memory.empty()) {
    if (scan.points.empty()) return estimate(stamp);
    reckoned_.push_back({stamp, {}});
    remember(scan);
  } else {
    follow(scan);
    if (is_new_view(memory.poses().back().inverse() * anchor_, options_) || sees_through_newest(scan)) {
      remember(scan);
      if (memory.size() > joints_.keyframes) judge_joints(memory.size() - joints_.keyframes + 1);
      close_loops(false);
    }
  }
  scans_.push_back(std::make_shared<const SurfaceScan>(std::move(scan)));
  follower_.note_scan(stamp);
  return estimate(stamp);
}

Memory GraphMapper::shown() const {
  Memory memory = map_.memory;
  for (const auto& [piece, by] : shown_from_piece_) memory.move_piece(by, piece);
  return memory;
}

bool GraphMapper::lies_on_earlier(std::size_t end) const {
  constexpr double kSameVisitM = 6.0;
  constexpr double kRadiusM = 40.0;
  constexpr double kInliers = 0.5;
  constexpr double kSamePlaceM = 0.15;
  const Memory& memory = map_.memory;
  if (memory.size() <= end) return false;
  const auto& keyframes = memory.keyframes();
  const auto since = keyframes.begin() + static_cast<std::ptrdiff_t>(end);
  if (std::any_of(since, keyframes.end(), [](const auto& k) { return k.cut; })) return !is_apart_;
  const Transform2<Map, Base>& here = memory.poses().back();
  std::vector<LocalMap::Piece> pieces;
  for (std::size_t k = 0; k < end; ++k)
    if (distance_m(memory.poses()[k].translation(), here.translation()) < kSameVisitM)
      pieces.push_back({memory.keyframes()[k].scan.get(), memory.poses()[k]});
  const LocalMap map(pieces, here.translation(), kRadiusM);
  const MatchResult match = map.refine(*memory.keyframes().back().scan, here, {}, {}, MatchStart::Near);
  return match.converged && match.inlier_share > kInliers && match.covered_share > kInliers &&
         distance_m(match.map_from_base.translation(), here.translation()) < kSamePlaceM;
}

/// Ties that were believed before the building was known to repeat itself so far.
void GraphMapper::untie_what_is_doubtful() {
  const std::vector<std::size_t> of = finder_.surely_tied(map_.memory);
  const auto is_doubtful = [&of](const Memory&, const RelativeFactor& f) {
    return of[static_cast<std::size_t>(f.from)] != of[static_cast<std::size_t>(f.to)];
  };
  if (map_.memory.forget_loops(is_doubtful) > 0) map_.memory.optimise({});
}

/// What nothing ties to the largest piece is forgotten. Returns how many scans that were.
int GraphMapper::keep_largest_piece() {
  Memory& memory = map_.memory;
  const std::vector<std::size_t> of = memory.pieces();
  const std::size_t largest = largest_piece(of);
  if (std::count(of.begin(), of.end(), largest) == std::ssize(of)) return 0;
  std::vector<std::size_t> scan_of;
  std::vector<ReckonedPose> reckoned;
  std::vector<std::shared_ptr<const SurfaceScan>> scans;
  for (std::size_t k = 0; k < of.size(); ++k) {
    if (of[k] != largest) continue;
    scan_of.push_back(scans.size());
    const std::size_t end = k + 1 < of.size() ? scan_of_[k + 1] : scans_.size();
    for (std::size_t i = scan_of_[k]; i < end; ++i) {
      reckoned.push_back(reckoned_[i]);
      scans.push_back(scans_[i]);
    }
  }
  const auto lost = static_cast<int>(scans_.size() - scans.size());
  memory.keep_piece(largest);
  scan_of_ = std::move(scan_of);
  reckoned_ = std::move(reckoned);
  scans_ = std::move(scans);
  return lost;
}

/// The way of every drive between two cuts laid on its keyframes.
std::vector<MomentPose> GraphMapper::laid_pieces(const Memory& memory) const {
  std::vector<MomentPose> laid;
  for (std::size_t begin = 0; begin < scan_of_.size();) {
    std::size_t end = begin + 1;
    while (end < scan_of_.size() && !memory.keyframes()[end].cut) ++end;
    const std::size_t first = scan_of_[begin];
    const std::size_t last = end < scan_of_.size() ? scan_of_[end] : reckoned_.size();
    const std::vector<ReckonedPose> way(reckoned_.begin() + static_cast<std::ptrdiff_t>(first),
                                        reckoned_.begin() + static_cast<std::ptrdiff_t>(last));
    std::vector<WayAnchor> anchors;
    for (std::size_t k = begin; k < end; ++k) anchors.push_back({scan_of_[k] - first, memory.poses()[k]});
    const std::vector<MomentPose> piece = laid_way(way, anchors);
    laid.insert(laid.end(), piece.begin(), piece.end());
    begin = end;
  }
  return laid;
}

/// The last look judges, ties and forgets: it is made on a copy, and the drive may go on.
FinishedMap GraphMapper::finish() {
  return GraphMapper(*this).finished();
}

FinishedMap GraphMapper::finished() {
  FinishedMap finished;
  if (map_.memory.empty()) return finished;
  judge_joints(map_.memory.size());
  close_loops(true);
  untie_what_is_doubtful();
  for (std::size_t k = 0; k < scan_of_.size(); ++k)
    if (map_.memory.keyframes()[k].cut) finished.carried.push_back(scans_[scan_of_[k]]->stamp);
  finished.lost_scans = keep_largest_piece();
  finished.memory = final_fit(map_.memory, options_.memory);
  finished.scans = laid_pieces(finished.memory);
  fit_scans(finished.memory, scan_of_, scans_, finished.scans);
  if (noise_.least_m() > kUsualNoiseM)
    finished.memory =
        bundle_noisy(finished.memory, scan_of_, scans_, noise_.least_m(), options_.memory, finished.scans);
  return finished;
}

}  // namespace madori::localization
