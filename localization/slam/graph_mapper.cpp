#include "localization/slam/graph_mapper.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "localization/localizer/pose_covariance.hpp"
#include "localization/localizer/scan_matcher.hpp"
#include "localization/memory/local_map.hpp"
#include "localization/slam/final_fit.hpp"

namespace madori::localization {
GraphMapper::GraphMapper(const LocalizerOptions& options) : options_(options), model_(options.odometry) {
  map_.memory = Memory(options.memory);
}

PoseEstimate GraphMapper::estimate(Stamp stamp) const {
  PoseEstimate estimate;
  estimate.stamp = stamp;
  estimate.map_from_base = anchor_ * since_scan_.motion;
  estimate.covariance = covariance_ + in_map_axes(since_scan_.covariance, anchor_.yaw_rad());
  estimate.health.state = state_;
  return estimate;
}

PoseEstimate GraphMapper::on_odometry(const OdometryReading& reading) {
  const OdometryReading before = track_.empty() ? reading : track_.newest();
  if (track_.add(reading)) {
    const Transform2<Base, Base> raw = before.odom_from_base.inverse() * reading.odom_from_base;
    model_.extend(since_scan_, raw);
    since_keyframe_.extend(raw, model_);
  }
  return estimate(reading.stamp);
}

void GraphMapper::follow(const SurfaceScan& scan, const OdometryStep& step) {
  const double enough = std::min(options_.sure_inliers, options_.known_share * usual_inliers_);
  auto [place, recent] = match_scan(scan, anchor_, step, enough, map_, options_);
  usual_inliers_ += 0.05 * (place.inlier_share - usual_inliers_);
  Transform2<Base, Base> motion = step.motion;
  if (recent.inlier_share > options_.lost_inliers) {
    motion = anchor_.inverse() * recent.map_from_base;
    since_keyframe_.add_matched(motion, recent.information, recent.inlier_share);
    model_.learn(step, motion, 0.02, 0.005);
  } else {
    since_keyframe_.add_unmatched(step.motion, recent.inlier_share);
  }
  const bool found = place.inlier_share > options_.lost_inliers;
  if (!found) {
    place.map_from_base = anchor_ * step.motion;
    place.information.setZero();
    map_.memory.note_break();
  }
  state_ = found ? LocalizationState::Localized : LocalizationState::Degraded;
  reckoned_.push_back({scan.stamp, reckoned_.back().odom_from_base * motion});
  anchor_ = place.map_from_base;
  covariance_ = matched_covariance(place, map_);
}

void GraphMapper::remember(const SurfaceScan& scan) {
  map_.memory.add(
      scan, since_keyframe_.path_m(), anchor_,
      map_.memory.empty() ? MeasuredMotion{} : since_keyframe_.measured(map_.memory.poses().back()));
  since_keyframe_ = {};
  scan_of_.push_back(reckoned_.size() - 1);
}

void GraphMapper::close_loops() {
  Memory& memory = map_.memory;
  const Transform2<Map, Base> newest = memory.poses().back();
  if (memory.close_loops() == 0) return;
  memory.optimise({});
  anchor_ = memory.poses().back() * newest.inverse() * anchor_;
}

PoseEstimate GraphMapper::on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor) {
  SurfaceScan scan = make_surface_scan(stamp, sensor, weighty_points(points), options_.scan);
  Memory& memory = map_.memory;
  if (memory.empty()) {
    if (scan.points.empty()) return estimate(stamp);
    reckoned_.push_back({stamp, {}});
    remember(scan);
  } else {
    follow(scan, track_.between(anchor_stamp_, stamp, model_));
    const Transform2<Base, Base> moved = memory.poses().back().inverse() * anchor_;
    if (std::hypot(moved.x_m(), moved.y_m()) > options_.keyframe_m ||
        std::abs(moved.yaw_rad()) > options_.keyframe_rad) {
      remember(scan);
      close_loops();
    }
  }
  scans_.push_back(std::make_shared<const SurfaceScan>(std::move(scan)));
  anchor_stamp_ = stamp;
  since_scan_ = track_.empty() ? OdometryStep{} : track_.between(stamp, track_.newest().stamp, model_);
  return estimate(stamp);
}

bool GraphMapper::lies_on_earlier(std::size_t end) const {
  constexpr double kNearM = 6.0;
  constexpr double kRadiusM = 40.0;
  constexpr double kInliers = 0.5;
  constexpr double kSamePlaceM = 0.15;
  const Memory& memory = map_.memory;
  if (memory.size() <= end) return false;
  const Transform2<Map, Base>& here = memory.poses().back();
  std::vector<LocalMap::Piece> pieces;
  for (std::size_t k = 0; k < end; ++k)
    if (distance_m(memory.poses()[k].translation(), here.translation()) < kNearM)
      pieces.push_back({memory.keyframes()[k].scan.get(), memory.poses()[k]});
  const LocalMap map(pieces, here.translation(), kRadiusM);
  const MatchResult match = map.refine(*memory.keyframes().back().scan, here, {}, {}, MatchStart::Near);
  return match.converged && match.inlier_share > kInliers && match.covered_share > kInliers &&
         distance_m(match.map_from_base.translation(), here.translation()) < kSamePlaceM;
}

FinishedMap GraphMapper::finish() {
  FinishedMap finished;
  if (map_.memory.empty()) return finished;
  finished.memory = final_fit(map_.memory, options_.memory);
  std::vector<WayAnchor> anchors;
  for (std::size_t k = 0; k < scan_of_.size(); ++k)
    anchors.push_back({scan_of_[k], finished.memory.poses()[k]});
  finished.scans = laid_way(reckoned_, anchors);
  fit_scans(finished.memory, scan_of_, scans_, finished.scans);
  return finished;
}

}  // namespace madori::localization
