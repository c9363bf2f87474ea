#include "app/panel/live_copy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>

#include "app/panel/notices.hpp"
#include "app/panel/reference_lidar.hpp"
#include "app/route_tools.hpp"
#include "core/angle.hpp"
#include "hmi/server/scan_frame.hpp"

namespace madori::app {
namespace {

constexpr double kShowEvery_s = 0.095;
constexpr double kPlacesEvery_s = 0.5;
constexpr double kScanEvery_s = 0.19;
constexpr double kSilent_s = 0.5;
constexpr double kFloor_m = 0.1;      ///< returns below are the floor
constexpr double kScanCell_m = 0.08;  ///< of several returns in one, a picture needs one
constexpr std::size_t kMostScanPoints = 2000;

void forget_old(std::deque<Stamp>& stamps, Stamp now) {
  while (!stamps.empty() && to_seconds(now - stamps.front()) > 1.0) stamps.pop_front();
}

hmi::DeviceStatus device(const char* name, const char* type, const std::optional<Stamp>& heard, Stamp now,
                         std::size_t rate) {
  const double age_s = heard ? to_seconds(now - *heard) : 1e6;
  hmi::DeviceStatus status{name, type, age_s < kSilent_s, std::min(age_s, 1e6), static_cast<double>(rate),
                           {}};
  if (!heard) status.detail = {"nothing-received", {}, "nothing received yet"};
  return status;
}

bool is_fresh(const std::optional<Stamp>& heard, Stamp now) {
  return heard && to_seconds(now - *heard) < kSilent_s;
}

std::uint64_t cell_of(const Point2<Lidar>& at) {
  const auto half = [](double value) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(std::lround(value / kScanCell_m)));
  };
  return half(at.x_m) << 32U | half(at.y_m);
}

}  // namespace

bool LiveCopy::due(Stamp now) {
  if (to_seconds(now - shown_) < kShowEvery_s) return false;
  shown_ = now;
  return true;
}

void LiveCopy::count_revolutions(const CycleInput& input) {
  revolutions_.insert(revolutions_.end(), input.clouds.size(), input.now);
  reports_.insert(reports_.end(), input.drive.size(), input.now);
  forget_old(revolutions_, input.now);
  forget_old(reports_, input.now);
}

void LiveCopy::enter(const std::string& state, Stamp now) {
  if (live_.state != state) live_.since = now;
  live_.state = state;
  live_.stamp = now;
}

/// The newest returns above the floor, one a cell, evenly chosen where these are still too many.
void LiveCopy::take_scan(const CycleInput& input, const planning::SensorView& lidar, double yaw_rad,
                         const Transform2<Map, Base>& pose) {
  if (input.clouds.empty() || to_seconds(input.now - scanned_) < kScanEvery_s) return;
  scanned_ = input.now;
  const auto& points = input.clouds.back().points;
  const Transform2<Base, Lidar> base_from_lidar(lidar.x_m, lidar.y_m, yaw_rad);
  std::vector<Point2<Base>> scan;
  std::unordered_set<std::uint64_t> taken;
  for (const CloudPoint& point : points) {
    if (static_cast<double>(point.z_m) + lidar.z_m <= kFloor_m) continue;
    const Point2<Lidar> at{static_cast<double>(point.x_m), static_cast<double>(point.y_m)};
    if (taken.insert(cell_of(at)).second) scan.push_back(base_from_lidar * at);
  }
  const std::size_t shown = std::min(scan.size(), kMostScanPoints);
  for (std::size_t k = 0; k < shown; ++k) scan[k] = scan[k * scan.size() / shown];
  scan.resize(shown);
  live_.scan = std::make_shared<const std::string>(hmi::scan_frame(scan, pose));
}

void LiveCopy::take_devices(Stamp now, const std::optional<Stamp>& lidar, const std::optional<Stamp>& drive,
                            const std::string& problem) {
  live_.devices = {device("lidar", "vlp16", lidar, now, revolutions_.size()),
                   device("drive", "drive", drive, now, reports_.size())};
  if (!problem.empty())
    live_.devices.push_back({"devices", "link", false, 0.0, std::nullopt, uncoded(problem)});
}

void LiveCopy::show(const CycleInput& input, const CycleState& state, const TransportRun& run) {
  const std::scoped_lock lock(mutex_);
  mode_ = state.mode;
  count_revolutions(input);
  take_scan(input, run.config().lidar, run.config().lidar_yaw_rad,
            state.site->on_drawing(state.pose.map_from_base));
  if (!due(input.now)) return;
  enter(to_string(state.mode), input.now);
  live_.drivable = true;
  live_.cause = shown(state.standstill.cause);
  live_.remedy = shown(state.standstill.remedy);
  live_.pose = state.pose;
  live_.pose.map_from_base = state.site->on_drawing(state.pose.map_from_base);
  live_.pose.stamp = std::min(state.pose.stamp, input.now);
  live_.velocity.reset();
  if (is_fresh(state.drive_heard, input.now))
    live_.velocity = VelocityCommand{state.odometry.linear_mps(), state.odometry.angular_radps()};
  live_.emergency_stop = state.mode == Mode::EmergencyStop;
  live_.order_id = input.order ? std::optional<long long>(input.order->id) : std::nullopt;
  live_.battery_v.reset();
  if (state.drive.battery_mv > 0 && is_fresh(state.drive_heard, input.now))
    live_.battery_v = state.drive.battery_mv / 1000.0;
  live_.goal =
      state.way.target ? node_name(run.config().routes, state.way.stop.node).value_or("") : std::string();
  live_.path.clear();
  for (const auto& point : state.way.plain.points)
    live_.path.push_back(state.site->on_drawing(point.position));
  live_.blocked.clear();
  if (state.way.blocked_since) live_.blocked.push_back(state.site->on_drawing(state.way.check.where));
  take_devices(input.now, state.lidar_heard, state.drive_heard, run.view().device_problem);
  take_places(state, input.now);
}

/// The hypotheses change once a revolution and cost more than the rest: twice a second is enough.
void LiveCopy::take_places(const CycleState& state, Stamp now) {
  if (to_seconds(now - placed_) < kPlacesEvery_s) return;
  placed_ = now;
  locate_.places.clear();
  live_.score.reset();
  for (const auto& place : state.localization->hypotheses())
    locate_.places.push_back({place.map_from_base, place.explained});
  if (!locate_.places.empty() && is_fresh(state.lidar_heard, now)) live_.score = locate_.places.front().score;
  // The places that compete while none is sure: the cloud of particles of this localization.
  live_.particles.clear();
  if (locate_.places.size() > 1)
    for (const auto& place : locate_.places) live_.particles.push_back(place.map_from_base);
  switch (state.pose.health.state) {
    case LocalizationState::Localized:
    case LocalizationState::Degraded:
      locate_.state = "located";
      break;
    case LocalizationState::Ambiguous:
      locate_.state = "ambiguous";
      break;
    case LocalizationState::Lost:
      locate_.state = is_fresh(state.lidar_heard, now) ? "searching" : "blind";
      break;
  }
}

void LiveCopy::show_setup(const CycleInput& input, const std::string& problem) {
  const std::scoped_lock lock(mutex_);
  mode_ = Mode::Paused;
  count_revolutions(input);
  const auto& mount = kReferenceLidar;
  const planning::SensorView lidar{.x_m = mount.x_m, .y_m = mount.y_m, .z_m = mount.z_m};
  take_scan(input, lidar, to_rad(mount.yaw_deg), {});
  if (!due(input.now)) return;
  const auto odometer_m = live_.odometer_m;
  auto scan = live_.scan;
  auto since = live_.since;
  auto state = live_.state;
  live_ = {};
  live_.odometer_m = odometer_m;
  live_.scan = std::move(scan);
  live_.since = since;
  live_.state = state;
  enter("setting-up", input.now);
  live_.cause = {"setting-up", {}, "the site is not complete yet"};
  live_.remedy = {"finish-setup", {}, "finish the five steps of the set-up"};
  live_.pose.stamp = input.now;
  live_.pose.health = {LocalizationState::Lost, "the site is not complete yet"};
  const auto newest = [](const std::deque<Stamp>& stamps) {
    return stamps.empty() ? std::nullopt : std::optional(stamps.back());
  };
  take_devices(input.now, newest(revolutions_), newest(reports_), problem);
  locate_ = {};
}

void LiveCopy::set_odometer(double metres) {
  const std::scoped_lock lock(mutex_);
  live_.odometer_m = metres;
}

hmi::LiveState LiveCopy::live() const {
  const std::scoped_lock lock(mutex_);
  return live_;
}

hmi::LocateView LiveCopy::locate() const {
  const std::scoped_lock lock(mutex_);
  return locate_;
}

Mode LiveCopy::mode() const {
  const std::scoped_lock lock(mutex_);
  return mode_;
}

bool LiveCopy::hears_lidar() const {
  const std::scoped_lock lock(mutex_);
  return !revolutions_.empty();
}

}  // namespace madori::app
