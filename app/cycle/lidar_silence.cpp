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

/// The younger of what several lidars told; nothing where none has told anything.
template <class Told>
std::optional<Stamp> youngest(const CycleState& state, const std::vector<std::size_t>& lidars,
                              const Told& told) {
  std::optional<Stamp> newest;
  for (const std::size_t i : lidars) newest = std::max(newest, told(state.lidars_heard[i]));
  return newest;
}

/// The lidars that look in a direction, Base frame.
std::vector<std::size_t> looking_at(const std::vector<LidarModel>& lidars, double bearing_rad) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < lidars.size(); ++i)
    if (planning::SensorView::of(lidars[i]).looks_at(bearing_rad)) found.push_back(i);
  return found;
}

}  // namespace

std::vector<std::size_t> place_lidars(const std::vector<LidarModel>& lidars) {
  std::vector<std::size_t> all, spinning;
  for (std::size_t i = 0; i < lidars.size(); ++i) {
    all.push_back(i);
    if (lidars[i].kind == LidarKind::Spinning) spinning.push_back(i);
  }
  return spinning.empty() ? all : spinning;
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
  std::optional<Stamp> oldest =
      youngest(state, place_lidars(config.lidars), [](const Hearing& h) { return h.heard; });
  for (std::size_t i = 0; i < Hearing::kBearings; ++i) {
    const auto looking = looking_at(config.lidars, bearing_of(static_cast<double>(i)));
    oldest = std::min(
        oldest, youngest(state, looking, [&](const Hearing& h) { return h.seen[i] ? h.seen[i] : h.heard; }));
  }
  return oldest;
}

}  // namespace madori::app
