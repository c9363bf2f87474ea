#include <algorithm>
#include <cmath>

#include "app/cycle/stages.hpp"
#include "core/angle.hpp"

namespace madori::app {
namespace {

/// Of the middle of a direction; half a step before the first and after the last likewise.
double bearing_of(double direction) {
  constexpr double kStepRad = to_rad(15.0);
  return (direction - 0.5 * (Hearing::kBearings - 1)) * kStepRad;
}

/// Slopes y/x between the directions, and at their two ends.
std::array<double, Hearing::kBearings + 1> edges() {
  std::array<double, Hearing::kBearings + 1> slopes{};
  for (std::size_t i = 0; i < slopes.size(); ++i)
    slopes[i] = std::tan(bearing_of(static_cast<double>(i) - 0.5));
  return slopes;
}

/// The younger of what the lidars told that are asked; nothing where none has told anything.
template <class Asked, class Told>
std::optional<Stamp> youngest(const CycleState& state, const Asked& asked, const Told& told) {
  std::optional<Stamp> newest;
  for (std::size_t i = 0; i < state.lidars_heard.size(); ++i)
    if (asked(i)) newest = std::max(newest, told(state.lidars_heard[i]));
  return newest;
}

}  // namespace

bool tells_place(const std::vector<LidarModel>& lidars, std::size_t lidar) {
  const auto spins = [](const LidarModel& model) { return model.kind == LidarKind::Spinning; };
  return spins(lidars[lidar]) || std::ranges::none_of(lidars, spins);
}

/// A lidar with lasers that look down sees at least the floor wherever it looks: a direction in which it saw
/// something, and sees nothing any more, is lost, be it by packets that do not come or by what covers it. A
/// level one may look into an open hall: its directions are not asked.
void note_heard(Hearing& hearing, const PointCloud<Base>& sweep, const LidarModel& lidar, Stamp now) {
  static const auto kEdges = edges();
  hearing.heard = now;
  if (lidar.kind != LidarKind::Spinning) return;
  for (const auto& point : sweep.points) {
    const double x_m = static_cast<double>(point.x_m) - lidar.mounting.x_m;
    if (x_m <= 0.0) continue;
    const double slope = (static_cast<double>(point.y_m) - lidar.mounting.y_m) / x_m;
    const auto after = static_cast<std::size_t>(std::ranges::upper_bound(kEdges, slope) - kEdges.begin());
    if (after > 0 && after < kEdges.size()) hearing.seen[after - 1] = now;
  }
}

std::optional<Stamp> heard_all(const CycleState& state, const CycleConfig& config) {
  if (state.lidars_heard.size() != config.lidars.size()) return std::nullopt;
  std::optional<Stamp> oldest = youngest(
      state, [&](std::size_t lidar) { return tells_place(config.lidars, lidar); },
      [](const Hearing& h) { return h.heard; });
  for (std::size_t i = 0; i < Hearing::kBearings; ++i) {
    const double bearing_rad = bearing_of(static_cast<double>(i));
    oldest =
        std::min(oldest, youngest(
                             state,
                             [&](std::size_t lidar) {
                               return planning::SensorView::of(config.lidars[lidar]).looks_at(bearing_rad);
                             },
                             [&](const Hearing& h) { return h.seen[i] ? h.seen[i] : h.heard; }));
  }
  return oldest;
}

}  // namespace madori::app
