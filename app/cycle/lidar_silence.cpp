#include <algorithm>
#include <cmath>

#include "app/cycle/stages.hpp"
#include "core/angle.hpp"
#include "core/fill_in.hpp"
#include "planning/obstacle_check/sure_sight.hpp"

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

/// The younger of what the lidars told that are asked; nothing where none has told anything. Who has longer
/// patience counts as heard later by what that is longer, never later than `now`.
template <class Asked, class Told>
std::optional<Stamp> youngest(const CycleState& state, const CycleConfig& config, Stamp now,
                              const Asked& asked, const Told& told) {
  std::optional<Stamp> newest;
  for (std::size_t i = 0; i < state.lidars_heard.size(); ++i) {
    if (!asked(i)) continue;
    const std::optional<Stamp> heard = told(state.lidars_heard[i]);
    const Duration more = duration_from_seconds(patience_s(config, i) - config.lidar_silent_s);
    if (heard) newest = std::max(newest, std::optional(std::max(*heard, std::min(*heard + more, now))));
  }
  return newest;
}

bool is_missed(const CycleState& state, std::size_t lidar, Stamp now, const CycleConfig& config) {
  const auto heard = lidar < state.lidars_heard.size() ? state.lidars_heard[lidar].heard : std::nullopt;
  return is_silent(std::max({heard, state.gap, std::optional(state.begun)}), now, patience_s(config, lidar));
}

/// The best that a lidar does which is heard; as configured while all are.
template <class RangeOf>
double of_those_heard(const CycleState& state, Stamp now, const CycleConfig& config, double all_m,
                      const RangeOf& range_of) {
  double heard_m = 0.0;
  bool any_missed = false;
  for (std::size_t i = 0; i < config.lidars.size(); ++i) {
    if (is_missed(state, i, now, config))
      any_missed = true;
    else
      heard_m = std::max(heard_m, range_of(config.lidars[i]));
  }
  return any_missed ? std::min(all_m, heard_m) : all_m;
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

double patience_s(const CycleConfig& config, std::size_t lidar) {
  constexpr double kSweeps = 2.5;
  return std::max(config.lidar_silent_s, kSweeps * config.lidars[lidar].period_s);
}

std::string silent_lidars(const CycleState& state, Stamp now, const CycleConfig& config) {
  std::string names;
  for (std::size_t i = 0; i < config.lidars.size(); ++i)
    if (is_missed(state, i, now, config)) names += (names.empty() ? "" : ", ") + config.lidars[i].name;
  return names;
}

double sure_range_m(const CycleState& state, Stamp now, const CycleConfig& config) {
  return of_those_heard(state, now, config, config.sure_range_m, [&](const LidarModel& lidar) {
    return std::min(planning::sure_ahead_m(lidar, config.check.vehicle.front_m), config.looked_at_m());
  });
}

double low_bodies_mps(const CycleState& state, Stamp now, const CycleConfig& config) {
  if (!config.low_bodies_guarded_by.empty()) return planning::PathCheck::kFree;
  const double sure_m = of_those_heard(state, now, config, config.sure_low_m, [&](const LidarModel& lidar) {
    return planning::sure_low_m(lidar, config.check.vehicle.front_m, config.field.reach_m);
  });
  return std::max(planning::kUnseenPersonMps, config.check.braking.speed_within(sure_m));
}

double unseen_bodies_mps(const CycleState& state, Stamp now, const CycleConfig& config) {
  const bool walker =
      std::ranges::any_of(state.movers, [](const MoverWatch& watch) { return watch.out_of_sight.anyone(); });
  return walker ? planning::kUnseenPersonMps : low_bodies_mps(state, now, config);
}

void say_floor_unseen(CycleState& state, const CycleInput& input, const CycleConfig& config,
                      CycleOutput& output) {
  const bool unseen = low_bodies_mps(state, input.now, config) <= planning::kUnseenPersonMps;
  if (!drives(state.mode) || unseen == state.floor_unseen) return;
  state.floor_unseen = unseen;
  const CatalogueEntry& words = unseen ? kFloorUnseenEvent : kFloorSeenEvent;
  output.events.push_back(fill_in(words.english, {{"speed", two_decimals(planning::kUnseenPersonMps)}}));
}

void say_missed_lidars(CycleState& state, const CycleInput& input, const CycleConfig& config,
                       CycleOutput& output) {
  if (config.lidars.size() < 2) return;
  state.lidars_missed.resize(config.lidars.size());
  const bool goes_on = !is_silent(state.lidar_heard, input.now, config.lidar_silent_s);
  for (std::size_t i = 0; i < config.lidars.size(); ++i) {
    const bool missed = is_missed(state, i, input.now, config);
    if (missed == (state.lidars_missed[i] != 0) || (missed && !goes_on)) continue;
    state.lidars_missed[i] = missed ? 1 : 0;
    const CatalogueEntry& words = missed ? kLidarLostEvent : kLidarBackEvent;
    output.events.push_back(fill_in(words.english, {{"name", config.lidars[i].name}}));
  }
}

std::optional<Stamp> heard_all(const CycleState& state, const CycleConfig& config, Stamp now) {
  if (state.lidars_heard.size() != config.lidars.size()) return std::nullopt;
  std::optional<Stamp> oldest = youngest(
      state, config, now, [&](std::size_t lidar) { return tells_place(config.lidars, lidar); },
      [](const Hearing& h) { return h.heard; });
  for (std::size_t i = 0; i < Hearing::kBearings; ++i) {
    const double bearing_rad = bearing_of(static_cast<double>(i));
    oldest =
        std::min(oldest, youngest(
                             state, config, now,
                             [&](std::size_t lidar) {
                               return planning::SensorView::of(config.lidars[lidar]).looks_at(bearing_rad);
                             },
                             [&](const Hearing& h) { return h.seen[i] ? h.seen[i] : h.heard; }));
  }
  return oldest;
}

}  // namespace madori::app
