#include "localization/drawing_learner/drawing_learner.hpp"

#include <utility>

namespace madori::localization {
namespace {

constexpr std::size_t kMostKeyframes = 400;  // then every other one is dropped, and the spacing doubles
constexpr double kRangeMaxM = 80.0;          // far walls tell the scale best

std::vector<Point2<Base>> places(const ScanPoints& points) {
  std::vector<Point2<Base>> list;
  list.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points.weight_of(i) > 0.0) list.push_back(points.point(i));
  return list;
}

}  // namespace

DrawingLearner::DrawingLearner(const mapping::Walls& walls) : walls_(walls), reliability_(walls) {}

bool DrawingLearner::is_keyframe(const PoseEstimate& pose) const {
  const auto state = pose.health.state;
  if (state != LocalizationState::Localized && state != LocalizationState::Degraded) return false;
  return keyframes_.empty() || distance_m(keyframes_.back().map_from_base.translation(),
                                          pose.map_from_base.translation()) >= spacing_m_;
}

bool DrawingLearner::is_due(const PoseEstimate& pose) const {
  return !walls_.empty() && (is_keyframe(pose) || reliability_.is_due(pose));
}

void DrawingLearner::observe(const ScanPoints& points, const Point2<Base>& sensor, const PoseEstimate& pose) {
  if (!is_due(pose)) return;
  const SurfaceScan scan = make_surface_scan(pose.stamp, sensor, places(points), {.range_max_m = kRangeMaxM});
  if (scan.points.empty()) return;
  reliability_.observe(scan, pose);
  if (!is_keyframe(pose)) return;
  keyframes_.push_back({pose.map_from_base, surface_pieces(scan)});
  if (keyframes_.size() > kMostKeyframes) thin();
}

void DrawingLearner::thin() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < keyframes_.size(); i += 2) std::swap(keyframes_[kept++], keyframes_[i]);
  keyframes_.resize(kept);
  spacing_m_ *= 2.0;
}

SelfCalibration DrawingLearner::calibrate() const {
  return self_calibrate(WallIndex(walls_), keyframes_, {});
}

}  // namespace madori::localization
