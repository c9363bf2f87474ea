#include <algorithm>

#include "app/cycle/stages.hpp"
#include "core/angle.hpp"

namespace madori::app {
namespace {

/// The younger of what several lidars told; nothing where none has told anything.
std::optional<Stamp> youngest(const CycleState& state, const std::vector<std::size_t>& lidars) {
  std::optional<Stamp> newest;
  for (const std::size_t i : lidars) newest = std::max(newest, state.lidars_heard[i]);
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

std::optional<Stamp> heard_all(const CycleState& state, const CycleConfig& config) {
  constexpr double kAheadRad = to_rad(60.0);
  constexpr double kStepRad = to_rad(15.0);
  if (state.lidars_heard.size() != config.lidars.size()) return std::nullopt;
  std::optional<Stamp> oldest = youngest(state, place_lidars(config.lidars));
  for (double bearing = -kAheadRad; bearing <= kAheadRad + 1e-9; bearing += kStepRad)
    oldest = std::min(oldest, youngest(state, looking_at(config.lidars, bearing)));
  return oldest;
}

}  // namespace madori::app
