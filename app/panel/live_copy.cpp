#include "app/panel/live_copy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>

#include "app/lidars.hpp"
#include "app/panel/notices.hpp"
#include "app/route_tools.hpp"
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

// What is said while no run has the vehicle.
constexpr CatalogueEntry kSettingUp{"setting-up", "the site is not complete yet"};
constexpr CatalogueEntry kFinishSetup{"finish-setup", "finish the five steps of the set-up"};
constexpr CatalogueEntry kMeasuring{"measuring",
                                    "the mountings are being measured: the vehicle drives by itself"};
constexpr CatalogueEntry kWaitOrStop{"wait-or-stop", "keep away and wait, or press Stop"};

/// The last second's, and two at least: a lidar that is asked for its scans may tell one in three seconds.
void forget_old(std::deque<Stamp>& stamps, Stamp now) {
  while (stamps.size() > 2 && to_seconds(now - stamps.front()) > 1.0) stamps.pop_front();
}

double rate_of(const std::deque<Stamp>& stamps, Stamp now) {
  const auto recent = std::ranges::count_if(stamps, [&](Stamp at) { return to_seconds(now - at) <= 1.0; });
  if (recent > 2 || stamps.size() < 2) return static_cast<double>(recent);
  const double since_s =
      std::max(to_seconds(stamps.back() - stamps.front()), to_seconds(now - stamps.back()));
  return since_s > 0.0 ? static_cast<double>(stamps.size() - 1) / since_s : 0.0;
}

hmi::DeviceStatus device(const std::string& name, const std::string& type, const std::optional<Stamp>& heard,
                         Stamp now, double rate_hz, double silent_s = kSilent_s) {
  const double age_s = heard ? to_seconds(now - *heard) : 1e6;
  hmi::DeviceStatus status{name,    type, lidar_title(type), age_s < silent_s, std::min(age_s, 1e6),
                           rate_hz, {}};
  if (!heard) status.detail = {"nothing-received", {}, "nothing received yet"};
  return status;
}

bool is_fresh(const std::optional<Stamp>& heard, Stamp now) {
  return heard && to_seconds(now - *heard) < kSilent_s;
}

/// Who stands learns nothing more: as soon as there are ranked places a person is asked, however unsure they
/// are.
std::string locate_state(LocalizationState known, bool sees, bool has_places) {
  if (known == LocalizationState::Localized || known == LocalizationState::Degraded) return "located";
  if (!sees) return "blind";
  return has_places ? "ambiguous" : "searching";
}

std::uint64_t cell_of(const Point2<Base>& at) {
  const auto half = [](double value) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(std::lround(value / kScanCell_m)));
  };
  return half(at.x_m) << 32U | half(at.y_m);
}

/// The returns above the floor.
std::vector<Point2<Base>> points_of(const PointCloud<Lidar>& cloud, const LidarModel& lidar) {
  const auto base_from_lidar = lidar.mounting.base_from_lidar();
  std::vector<Point2<Base>> points;
  for (const CloudPoint& point : cloud.points)
    if (static_cast<double>(point.z_m) + lidar.mounting.z_m > kFloor_m)
      points.push_back(base_from_lidar *
                       Point2<Lidar>{static_cast<double>(point.x_m), static_cast<double>(point.y_m)});
  return points;
}

std::vector<Point2<Base>> points_of(const LaserScan& scan, const LidarModel& lidar) {
  const auto base_from_lidar = lidar.mounting.base_from_lidar();
  std::vector<Point2<Base>> points;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const double range_m = scan.ranges_m[i], angle_rad = scan.angle_rad(i);
    if (range_m > 0.0 && range_m < scan.range_max_m)
      points.push_back(base_from_lidar *
                       Point2<Lidar>{range_m * std::cos(angle_rad), range_m * std::sin(angle_rad)});
  }
  return points;
}

}  // namespace

bool LiveCopy::due(Stamp now) {
  if (to_seconds(now - shown_) < kShowEvery_s) return false;
  shown_ = now;
  return true;
}

void LiveCopy::count_revolutions(const CycleInput& input) {
  counted_ = input.now;
  const auto count = [&](std::size_t lidar) {
    revolutions_[lidar].push_back(input.now);
    heard_[lidar] = input.now;
  };
  for (const auto& cloud : input.clouds) count(cloud.lidar);
  for (const auto& scan : input.scans) count(scan.lidar);
  reports_.insert(reports_.end(), input.drive.size(), input.now);
  for (auto& [lidar, stamps] : revolutions_) forget_old(stamps, input.now);
  forget_old(reports_, input.now);
}

void LiveCopy::enter(const std::string& state, Stamp now) {
  if (live_.state != state) live_.since = now;
  live_.state = state;
  live_.stamp = now;
}

/// The newest returns above the floor of all lidars, one a cell, evenly chosen where these are still too
/// many.
void LiveCopy::take_scan(const CycleInput& input, const std::vector<LidarModel>& lidars,
                         const Transform2<Map, Base>& pose) {
  if (input.clouds.empty() && input.scans.empty()) return;
  if (to_seconds(input.now - scanned_) < kScanEvery_s) return;
  scanned_ = input.now;
  for (const auto& cloud : input.clouds)
    if (cloud.lidar < lidars.size()) seen_[cloud.lidar] = {input.now, points_of(cloud, lidars[cloud.lidar])};
  for (const auto& scan : input.scans)
    if (scan.lidar < lidars.size()) seen_[scan.lidar] = {input.now, points_of(scan, lidars[scan.lidar])};
  std::vector<Point2<Base>> scan;
  std::unordered_set<std::uint64_t> taken;
  for (const auto& [lidar, look] : seen_)
    if (is_fresh(look.first, input.now))
      for (const auto& at : look.second)
        if (taken.insert(cell_of(at)).second) scan.push_back(at);
  const std::size_t shown = std::min(scan.size(), kMostScanPoints);
  for (std::size_t k = 0; k < shown; ++k) scan[k] = scan[k * scan.size() / shown];
  scan.resize(shown);
  live_.scan = std::make_shared<const std::string>(hmi::scan_frame(scan, pose));
}

void LiveCopy::take_devices(Stamp now, const std::vector<LidarModel>& lidars,
                            const std::optional<Stamp>& drive, const std::string& problem) {
  live_.devices.clear();
  for (std::size_t i = 0; i < lidars.size(); ++i) {
    const auto heard = heard_.find(i);
    live_.devices.push_back(device(lidars.size() == 1 ? "lidar" : lidars[i].name, lidars[i].type,
                                   heard == heard_.end() ? std::nullopt : std::optional(heard->second), now,
                                   rate_of(revolutions_[i], now),
                                   std::max(kSilent_s, 2.5 * lidars[i].period_s)));
  }
  live_.devices.push_back(device("drive", "drive", drive, now, rate_of(reports_, now)));
  if (!problem.empty())
    live_.devices.push_back({"devices", "link", "", false, 0.0, std::nullopt, uncoded(problem)});
}

void LiveCopy::show(const CycleInput& input, const CycleState& state, const CycleConfig& config,
                    const std::string& device_problem) {
  const std::scoped_lock lock(mutex_);
  mode_ = state.mode;
  count_revolutions(input);
  take_scan(input, config.lidars, state.site->on_drawing(state.pose.map_from_base));
  if (!due(input.now)) return;
  enter(to_string(state.mode), input.now);
  live_.drivable = !config.mapping;
  live_.mapping = config.mapping;
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
      state.errand.target ? node_name(config.routes, state.errand.stop.node).value_or("") : std::string();
  live_.path.clear();
  for (const auto& point : state.way.plain.points)
    live_.path.push_back(state.site->on_drawing(point.position));
  live_.blocked.clear();
  if (state.block.since) live_.blocked.push_back(state.site->on_drawing(state.ahead.check.where));
  take_devices(input.now, config.lidars, state.drive_heard, device_problem);
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
  locate_.state =
      locate_state(state.pose.health.state, is_fresh(state.lidar_heard, now), !locate_.places.empty());
}

void LiveCopy::show_setup(const CycleInput& input, const std::vector<LidarModel>& lidars,
                          const std::string& problem) {
  const std::scoped_lock lock(mutex_);
  const bool sees = show_without_run(input, lidars, problem, kSettingUp, kFinishSetup);
  locate_ = {sees ? "setting-up" : "blind", {}};
}

void LiveCopy::show_measuring(const CycleInput& input, const std::vector<LidarModel>& lidars,
                              const std::string& problem) {
  const std::scoped_lock lock(mutex_);
  const bool sees = show_without_run(input, lidars, problem, kMeasuring, kWaitOrStop);
  locate_ = {sees ? "searching" : "blind", {}};
}

/// The state is called as its cause. Whether a lidar is heard.
bool LiveCopy::show_without_run(const CycleInput& input, const std::vector<LidarModel>& lidars,
                                const std::string& problem, const CatalogueEntry& cause,
                                const CatalogueEntry& remedy) {
  mode_ = Mode::Paused;
  count_revolutions(input);
  take_scan(input, lidars, {});
  const bool sees =
      std::ranges::any_of(heard_, [&](const auto& lidar) { return is_fresh(lidar.second, input.now); });
  if (!due(input.now)) return sees;
  hmi::LiveState next;
  next.odometer_m = live_.odometer_m;
  next.scan = std::move(live_.scan);
  next.since = live_.since;
  next.state = live_.state;
  live_ = std::move(next);
  enter(cause.code, input.now);
  live_.cause = shown(notice(cause));
  live_.remedy = shown(notice(remedy));
  live_.pose.stamp = input.now;
  live_.pose.health = {LocalizationState::Lost, live_.cause.text};
  const auto newest = [](const std::deque<Stamp>& stamps) {
    return stamps.empty() ? std::nullopt : std::optional(stamps.back());
  };
  take_devices(input.now, lidars, newest(reports_), problem);
  return sees;
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

LiveCopy::Look LiveCopy::look(std::size_t lidar) const {
  constexpr std::size_t kMost = 400;
  const std::scoped_lock lock(mutex_);
  Look look;
  if (const auto stamps = revolutions_.find(lidar); stamps != revolutions_.end())
    look.rate_hz = rate_of(stamps->second, counted_);
  const auto found = seen_.find(lidar);
  if (found == seen_.end()) return look;
  const auto& points = found->second.second;
  const std::size_t shown = std::min(points.size(), kMost);
  for (std::size_t i = 0; i < shown; ++i) look.points.push_back(points[i * points.size() / shown]);
  return look;
}

}  // namespace madori::app
