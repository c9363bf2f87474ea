#include <algorithm>
#include <cmath>

#include "app/cycle/stages.hpp"
#include "core/scan_as_cloud.hpp"
#include "core/sweep_in_base.hpp"

namespace madori::app {
namespace {

constexpr double kTrackS = 3.0;  ///< revolutions may have waited so long on a busy computer

/// Whether the drive was switched off and on between two statuses: its clock, which starts at power-up and
/// wraps after 71.6 min, went back, or ran ahead of ours; or its frames, one every 10 ms from zero on, were
/// not counted on with it. Statuses that have waited in a buffer, come twice, or were lost in between are no
/// sign.
bool was_switched_off(const CycleState& state, const control::wire::Status& status, Stamp now) {
  constexpr double kSlackS = 1.0;
  constexpr double kPeriodUs = 1e4, kPeriodsOff = 0.02;  // of the drive's timer
  const auto step_us = static_cast<std::int32_t>(status.time_us - state.drive.time_us);
  const Stamp expected = state.drive_clock.stamp_of(state.drive_us + step_us);
  const auto frames = static_cast<std::uint16_t>(status.sequence - state.drive.sequence);
  const auto periods = std::llround(step_us / kPeriodUs);
  const auto off = static_cast<std::int16_t>(frames - static_cast<std::uint16_t>(periods));
  const double slack = kSlackS * 1e6 / kPeriodUs + kPeriodsOff * static_cast<double>(std::abs(periods));
  return step_us * 1e-6 < -kSlackS || to_seconds(expected - now) > kSlackS || std::abs(off) > slack;
}

/// What any status of a step tells of the wheels: a stop between two looks is a stop. Power that comes back
/// is held like an emergency stop: nothing goes on by itself.
void note_stop(CycleState& state, const control::wire::Status& status, bool restarted) {
  const bool faulty = tells_fault(status);
  const bool unseen = state.drive_heard && status.stops != state.drive.stops && !faulty;
  state.drive_stopped = state.drive_stopped || restarted || unseen || tells_stop(status);
  state.drive_faulty = state.drive_faulty || faulty;
}

/// When the wheels were measured, by the controller's clock: a step that comes late, on a busy computer, does
/// not make its readings later. The scans have their times from the lidar's clock in the same way.
Stamp measured_at(CycleState& state, const control::wire::Status& status, Stamp now, bool restarted) {
  const bool first = !state.drive_heard || restarted;
  if (first) state.drive_clock.reset();
  state.drive_us =
      first ? 0 : state.drive_us + static_cast<std::int32_t>(status.time_us - state.drive.time_us);
  state.drive_clock.observe(state.drive_us, now);
  return state.drive_clock.stamp_of(state.drive_us);
}

/// Where the wheels were at a moment, between the readings around it.
Transform2<Odom, Base> odometry_at(const Ring<OdometryReading>& track, Stamp moment) {
  const auto after = std::lower_bound(track.begin(), track.end(), moment,
                                      [](const auto& reading, Stamp at) { return reading.stamp < at; });
  if (after == track.begin()) return track.front().odom_from_base;
  if (after == track.end()) return track.back().odom_from_base;
  const auto& before = *(after - 1);
  const double share = to_seconds(moment - before.stamp) / to_seconds(after->stamp - before.stamp);
  const auto step = before.odom_from_base.inverse() * after->odom_from_base;
  return before.odom_from_base *
         Transform2<Base, Base>(share * step.x_m(), share * step.y_m(), share * step.yaw_rad());
}

/// Whether a return is of the vehicle itself, or of nothing: no body stands where the vehicle does. A level
/// lidar that looks along its sides may see them; what is higher than all of it, it drives under.
bool is_own(const Point2<Base>& at, double height_m, const CycleConfig& config) {
  return height_m < config.field.top_m && config.check.vehicle.contains(at);
}

void lay_in_base(const PointCloud<Lidar>& cloud, const Ring<OdometryReading>& track,
                 const CycleConfig& config, PointCloud<Base>& sweep, std::vector<Point2<Base>>& within) {
  const LidarModel& lidar = config.lidars[cloud.lidar];
  within.clear();
  within.reserve(cloud.points.size());
  sweep_in_base(
      cloud, lidar.mounting,
      [&](Stamp moment) { return track.empty() ? std::nullopt : std::optional(odometry_at(track, moment)); },
      [&](const Point2<Base>& at, double height_m) {
        const bool own = is_own(at, height_m, config);
        if (own && height_m > config.field.ground_clearance_m) within.push_back(at);
        return !own;
      },
      sweep);
}

/// Whether nobody knows any more where the vehicle was when a revolution was taken: its bodies would stand
/// where they are not. Where the track has just begun, the vehicle stood.
bool is_too_old(const PointCloud<Lidar>& cloud, const Ring<OdometryReading>& track) {
  constexpr double kWholeTrackS = 0.9 * kTrackS;
  return !track.empty() && cloud.stamp < track.front().stamp &&
         to_seconds(track.back().stamp - track.front().stamp) > kWholeTrackS;
}

/// After a gap the stamps of lidar and drive may need a while to follow the computer's clock: only those that
/// are as young as they must be tell of now, and fit together.
bool ends_gap(const CycleState& state, std::size_t lidar, Stamp measured, Stamp now,
              const CycleConfig& config) {
  return state.gap && measured >= *state.gap && to_seconds(now - measured) < patience_s(config, lidar) &&
         to_seconds(now - state.odometry.reading().stamp) < config.drive_silent_s;
}

/// What is no pose is refused here: it reaches the cycle from a panel.
void take_given_pose(CycleState& state, const GivenPose& given) {
  const Transform2<Map, Base> pose(given.position.x_m, given.position.y_m, given.yaw_rad);
  const auto& [position_m, yaw_rad] = given.sigma;
  if (!pose.is_finite() || !(position_m > 0.0 && position_m < 1e3 && yaw_rad > 0.0 && yaw_rad < 10.0)) return;
  state.localization->set_pose(pose, given.sigma);
}

/// Routes, walls and the path at hand move with what is believed of how the drawing lies.
void follow_drawing(CycleState& state, const CycleConfig& config) {
  if (!state.site->differs(state.localization->bent())) return;
  auto site = std::make_shared<const SiteInBuilding>(state.site->carried(state.localization->bent()));
  if (!state.way.path.empty() && !state.way.backing) {
    state.way.plain = state.site->carry_to(*site, std::move(state.way.plain));
    state.way.path = control::TrackedPath(state.way.plain, config.pursuit.speed);
  }
  state.site = std::move(site);
}

/// One sweep to everybody who looks. A lidar that is faster than the way need be checked tells the obstacles
/// of every sweep, and its movers, whose speeds want time between two looks, of some.
void take_sweep(CycleState& state, const PointCloud<Lidar>& cloud, const CycleInput& input,
                const CycleConfig& config, CycleOutput& output) {
  constexpr double kLookAgainS = 0.08;
  if (cloud.lidar >= config.lidars.size() || is_too_old(cloud, state.track)) return;
  lay_in_base(cloud, state.track, config, state.bench.sweep, state.bench.within);
  const PointCloud<Base>& base = state.bench.sweep;
  state.lidars_heard.resize(config.lidars.size());
  const bool tells_of_now = to_seconds(input.now - base.stamp) < patience_s(config, cloud.lidar);
  if (tells_of_now || state.gap)
    note_heard(state.lidars_heard[cloud.lidar], base, config.lidars[cloud.lidar], input.now);
  if (ends_gap(state, cloud.lidar, base.stamp, input.now, config)) state.gap.reset();
  const auto odom_from_base =
      state.track.empty() ? Transform2<Odom, Base>() : odometry_at(state.track, base.stamp);
  state.localization->on_cloud(base, odom_from_base);
  take_pose(state, state.localization->on_odometry(state.odometry.reading()));
  note_anchor(state, base.stamp);
  state.obstacles.update(base, planning::SensorView::of(config.lidars[cloud.lidar]), odom_from_base,
                         state.bench.within);
  MoverWatch& watch = state.movers[cloud.lidar];
  const double since_s = to_seconds(base.stamp - watch.looked);
  if (since_s >= 0.0 && since_s < kLookAgainS) return;
  watch.looked = base.stamp;
  output.computed_lidar = true;
  watch.objects.update(state.obstacles.columns(), base.stamp);
  watch.out_of_sight.update(watch.objects, config.lidars, odom_from_base, base.stamp);
}

}  // namespace

void localize(CycleState& state, const CycleInput& input, const CycleConfig& config, CycleOutput& output) {
  state.localization->set_thinking(input.thinking);
  state.drive_stopped = state.drive_faulty = false;
  constexpr std::chrono::microseconds kStale(control::wire::kWatchdogMicroseconds);
  if (state.drive_heard) note_stop(state, state.drive, false);
  for (const auto& status : input.drive) {
    const bool off = state.drive_heard && was_switched_off(state, status, input.now);
    note_stop(state, status, off);
    const Stamp stamp = measured_at(state, status, input.now, off);
    // Frames that come again, or of a controller that sends on but measures no more, are no sign of life.
    if (!state.drive_heard || status.time_us != state.drive.time_us) state.drive_heard = input.now;
    state.drive = status;
    const bool is_deaf = status.state == control::wire::DriveState::WatchdogStop;
    state.drive_deaf = is_deaf ? state.drive_deaf.value_or(input.now) : std::optional<Stamp>();
    if (!is_deaf && input.drive_behind > kStale) state.drive_late = input.now;
    state.odometry.update(status, stamp);
    const OdometryReading& reading = state.odometry.reading();
    if (!state.track.empty() && reading.stamp <= state.track.back().stamp) continue;
    state.track.push_back(reading);
    while (to_seconds(reading.stamp - state.track.front().stamp) > kTrackS) state.track.pop_front();
    take_pose(state, state.localization->on_odometry(reading));
  }
  for (const auto& command : input.commands) {
    if (command.word == OperatorWord::SetPose) take_given_pose(state, command.given_pose);
    if (command.word == OperatorWord::SearchPose) state.localization->search_anew();
  }
  for (const auto& cloud : input.clouds) take_sweep(state, cloud, input, config, output);
  for (const auto& scan : input.scans) {
    scan_as_cloud(scan, state.bench.scan);
    take_sweep(state, state.bench.scan, input, config, output);
  }
  state.lidar_heard = heard_all(state, config, input.now);
  follow_drawing(state, config);
}

}  // namespace madori::app
