#include "app/mounting/mounting_manoeuvre.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/mounting/mounting_words.hpp"
#include "core/angle.hpp"
#include "core/scan_as_cloud.hpp"

namespace madori::app {
namespace {

using Stage = MountingManoeuvre::Stage;

constexpr double kStandS = 1.0;  // before and after: sweeps of a vehicle at rest
constexpr double kGuardReachM = 3.0;
constexpr double kCellM = 0.05;
constexpr double kFloorM = 0.12;
constexpr double kOwnMarginM = 0.05;
constexpr double kGuardMarginM = 0.08;

bool moves(Stage stage) {
  return stage == Stage::Forward || stage == Stage::Turning || stage == Stage::Back;
}

/// A stage that takes longer has a vehicle that does not get on.
double longest_s(Stage stage, const MountingDriveOptions& options) {
  constexpr double kWaitsS = 20.0;
  return kWaitsS + 3.0 * (stage == Stage::Turning ? options.turn_rad / options.turn_radps
                                                  : options.way_m / options.speed_mps);
}

Transform2<Map, Odom> as_map() {  // the guard asks for places of the Map; here dead reckoning stands in
  return {};
}

}  // namespace

MountingManoeuvre::MountingManoeuvre(CycleConfig vehicle, const MountingDriveOptions& options)
    : vehicle_(std::move(vehicle)), options_(options) {
  vehicle_.guard.body_margin_m = kGuardMarginM;
  vehicle_.limits.acceleration_mps2 = std::min(vehicle_.limits.acceleration_mps2, 0.3);
  vehicle_.limits.turn_acceleration_radps2 = std::min(vehicle_.limits.turn_acceleration_radps2, 0.5);
}

void MountingManoeuvre::stop(Notice why) {
  if (stage_ == Stage::Done) return;
  stage_ = Stage::Stopped;
  notice_ = std::move(why);
}

double MountingManoeuvre::progress() const {
  const double way = done_ / options_.way_m, turn = done_ / options_.turn_rad;
  switch (stage_) {
    case Stage::Standing:
      return 0.0;
    case Stage::Forward:
      return 0.2 * std::min(way, 1.0);
    case Stage::Turning:
      return 0.2 + 0.6 * std::min(turn, 1.0);
    case Stage::Back:
      return 0.8 + 0.2 * std::min(way, 1.0);
    default:
      return 1.0;
  }
}

/// What stands above the floor and not on the vehicle, one point a cell.
void MountingManoeuvre::see(const PointCloud<Lidar>& sweep, const Transform2<Odom, Base>& odom_from_base) {
  if (sweep.lidar >= vehicle_.lidars.size()) return;
  const LidarModel& lidar = vehicle_.lidars[sweep.lidar];
  const auto base_from_lidar = lidar.mounting.base_from_lidar();
  const auto own = vehicle_.check.vehicle.grown(kOwnMarginM, kOwnMarginM);
  const bool spins = lidar.kind == LidarKind::Spinning;
  Seen& seen = seen_[sweep.lidar];
  seen.at = sweep.stamp;
  seen.points.clear();
  std::map<std::pair<int, int>, bool> taken;
  for (const CloudPoint& p : sweep.points) {
    const double height_m = lidar.mounting.z_m + static_cast<double>(p.z_m);
    if (spins && (height_m < kFloorM || height_m > vehicle_.field.top_m)) continue;
    const Point2<Base> at =
        base_from_lidar * Point2<Lidar>{static_cast<double>(p.x_m), static_cast<double>(p.y_m)};
    if (std::hypot(at.x_m, at.y_m) > kGuardReachM || own.contains(at)) continue;
    const std::pair cell(static_cast<int>(std::floor(at.x_m / kCellM)),
                         static_cast<int>(std::floor(at.y_m / kCellM)));
    if (!std::exchange(taken[cell], true)) seen.points.push_back(odom_from_base * at);
  }
}

Notice MountingManoeuvre::held_by(const CycleInput& input) const {
  if (!drive_heard_ || to_seconds(input.now - *drive_heard_) > vehicle_.drive_silent_s)
    return app::notice(kMountingDriveSilent);
  if (input.protective_stop) return app::notice(kMountingField);
  for (std::size_t i = 0; i < vehicle_.lidars.size(); ++i) {
    const LidarModel& lidar = vehicle_.lidars[i];
    const double limit_s = std::max(0.5, 3.0 * lidar.period_s);
    const auto found = seen_.find(i);
    if (found == seen_.end() || to_seconds(input.now - found->second.at) > limit_s)
      return app::notice(kMountingLidarSilent, {{"name", lidar.name}});
  }
  return {};
}

double MountingManoeuvre::free_share(const Transform2<Odom, Base>& odom_from_base,
                                     const VelocityCommand& v) const {
  std::vector<Point2<Map>> obstacles;
  for (const auto& [lidar, seen] : seen_)
    for (const auto& p : seen.points) obstacles.push_back(as_map() * p);
  return planning::guarded_share(as_map() * odom_from_base, v, obstacles, planning::WallGrid(),
                                 vehicle_.check.vehicle, vehicle_.check.braking, vehicle_.guard);
}

/// Slower towards the end of the stage, so that it is met.
VelocityCommand MountingManoeuvre::wanted(const Transform2<Odom, Base>& odom_from_base) {
  const auto since = from_.inverse() * odom_from_base;
  if (stage_ == Stage::Turning) {
    done_ += wrap_angle(odom_from_base.yaw_rad() - last_.yaw_rad());
    last_ = odom_from_base;
    const double left_rad = options_.turn_rad - done_;
    return {0.0, std::clamp(left_rad, 0.05, options_.turn_radps)};
  }
  const double direction = stage_ == Stage::Back ? -1.0 : 1.0;
  done_ = direction * since.x_m();
  const double left_m = options_.way_m - done_;
  return {direction * std::clamp(left_m, 0.03, options_.speed_mps), 0.0};
}

bool MountingManoeuvre::is_over(Stamp now) const {
  if (!moves(stage_)) return to_seconds(now - *begun_) > kStandS;
  return stage_ == Stage::Turning ? done_ > options_.turn_rad - 0.01 : done_ > options_.way_m - 0.005;
}

void MountingManoeuvre::go_on(const Transform2<Odom, Base>& odom_from_base, Stamp now) {
  stage_ = static_cast<Stage>(static_cast<int>(stage_) + 1);
  begun_ = now;
  from_ = last_ = odom_from_base;
  done_ = 0.0;
}

/// As the cycle: a drive that is idle arms itself on a command that does not enable it.
bool MountingManoeuvre::enables() {
  constexpr int kStepsToRun = 10;
  const bool idle = drive_.state == control::wire::DriveState::Idle ||
                    drive_.state == control::wire::DriveState::WatchdogStop;
  unarmed_steps_ = idle && unarmed_steps_ < kStepsToRun ? unarmed_steps_ + 1 : 0;
  return !idle || unarmed_steps_ > 0;
}

CycleOutput MountingManoeuvre::step(const CycleInput& input, const OdometryReading& odometry) {
  CycleOutput output;
  const auto& here = odometry.odom_from_base;
  for (const auto& status : input.drive) {
    const bool unseen = drive_heard_ && status.stops != drive_.stops;
    if (unseen || tells_stop(status) || tells_fault(status)) stop(app::notice(kMountingDriveStopped));
    drive_ = status;
    drive_heard_ = input.now;
  }
  for (const auto& cloud : input.clouds) see(cloud, here);
  for (const auto& scan : input.scans) {
    PointCloud<Lidar> sweep;
    scan_as_cloud(scan, sweep);
    see(sweep, here);
  }
  const double step_s = previous_ ? to_seconds(input.now - *previous_) : 0.0;
  previous_ = input.now;
  if (stage_ == Stage::Done || stage_ == Stage::Stopped) return output;
  if (!begun_) begun_ = input.now, from_ = last_ = here;
  notice_ = held_by(input);
  VelocityCommand asked;
  if (notice_.empty() && moves(stage_)) {
    asked = wanted(here);
    const double share = free_share(here, asked);
    asked = {asked.linear_mps * share, asked.angular_radps * share};
    if (share < 0.1) notice_ = app::notice(kMountingBlocked);
  }
  if (notice_.empty()) {
    held_since_.reset();
    if (is_over(input.now)) go_on(here, input.now), asked = {};
  } else {
    if (!held_since_) held_since_ = input.now;
    if (to_seconds(input.now - *held_since_) > options_.patience_s) stop(Notice(notice_));
  }
  if (moves(stage_) && to_seconds(input.now - *begun_) > longest_s(stage_, options_))
    stop(app::notice(kMountingMoved));
  const bool may_move = notice_.empty() && moves(stage_);
  const auto limited = control::limit(
      limits_, {.requested = asked, .may_move = may_move, .step_s = std::max(step_s, 1e-3)}, vehicle_.limits);
  limits_ = limited.state;
  output.command = limited.command;
  output.enable = may_move && enables();
  return output;
}

}  // namespace madori::app
