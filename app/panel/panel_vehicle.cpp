#include "app/panel/panel_vehicle.hpp"

#include <algorithm>
#include <chrono>

namespace madori::app {
namespace {

constexpr double kShowEvery_s = 0.1;
constexpr std::size_t kMostScanPoints = 20'000;
constexpr int kMostRepeats = 1000;

hmi::Notice shown(const Notice& notice) {
  return {notice.code, notice.values, notice.text};
}

/// What has no code yet.
hmi::Notice plain(const std::string& text) {
  return text.empty() ? hmi::Notice{} : hmi::Notice{"", {}, text};
}

Stamp wall_clock() {
  return std::chrono::time_point_cast<Duration>(std::chrono::system_clock::now());
}

std::vector<hmi::DeviceStatus> devices_of(const CycleState& state, Stamp now, const std::string& problem) {
  const auto device = [now](const char* name, const char* type, const std::optional<Stamp>& heard,
                            double limit_s) {
    const double age_s = heard ? to_seconds(now - *heard) : 1e9;
    return hmi::DeviceStatus{name, type, age_s < limit_s, std::min(age_s, 1e6),
                             heard ? "" : "nothing received yet"};
  };
  auto list = std::vector{device("lidar", "vlp16", state.lidar_heard, 0.5),
                          device("drive", "drive", state.drive_heard, 0.5)};
  if (!problem.empty()) list.push_back({"devices", "link", false, 0.0, problem});
  return list;
}

}  // namespace

PanelVehicle::PanelVehicle(TransportRun& run, const std::filesystem::path& database)
    : run_(run), store_(database) {}

/// The newest returns above the floor, on the map.
void PanelVehicle::show_scan(const CycleInput& input, const CycleState& state) {
  if (input.clouds.empty()) return;
  const auto& points = input.clouds.back().points;
  const auto& lidar = run_.config().lidar;
  const auto map_from_lidar =
      state.pose.map_from_base * Transform2<Base, Lidar>(lidar.x_m, lidar.y_m, run_.config().lidar_yaw_rad);
  const std::size_t stride = points.size() / kMostScanPoints + 1;
  live_.scan.clear();
  for (std::size_t i = 0; i < points.size(); i += stride)
    if (static_cast<double>(points[i].z_m) + lidar.z_m > 0.1)
      live_.scan.push_back(map_from_lidar * Point2<Lidar>{static_cast<double>(points[i].x_m),
                                                          static_cast<double>(points[i].y_m)});
}

void PanelVehicle::observe(const CycleInput& input, const CycleState& state) {
  const std::scoped_lock lock(mutex_);
  mode_ = state.mode;
  show_scan(input, state);
  if (to_seconds(input.now - shown_) < kShowEvery_s) return;
  shown_ = input.now;
  const std::string name = to_string(state.mode);
  if (live_.state != name) live_.since = input.now;
  live_.state = name;
  live_.stamp = input.now;
  live_.cause = shown(state.standstill.cause);
  live_.remedy = shown(state.standstill.remedy);
  live_.pose = state.pose;
  live_.pose.stamp = wall_clock();  // the panel shows ages by its own clock
  live_.velocity = run_.view().command;
  live_.emergency_stop = state.mode == Mode::EmergencyStop;
  live_.order_id = input.order ? std::optional<long long>(input.order->id) : std::nullopt;
  live_.goal.clear();
  if (state.way.target)
    if (const auto node = run_.config().routes.index_of(state.way.stop.node)) {
      const auto& goal = run_.config().routes.nodes()[*node];
      live_.goal = goal.name.empty() ? std::to_string(goal.id) : goal.name;
    }
  live_.path.clear();
  for (const auto& point : state.way.plain.points) live_.path.push_back(point.position);
  live_.devices = devices_of(state, input.now, run_.view().device_problem);
}

hmi::LiveState PanelVehicle::live() const {
  const std::scoped_lock lock(mutex_);
  return live_;
}

Mode PanelVehicle::mode() const {
  const std::scoped_lock lock(mutex_);
  return mode_;
}

hmi::Reply PanelVehicle::command(hmi::Command command) {
  const auto say = [this](OperatorWord word) { run_.say({word, {}}); };
  const Mode now = mode();
  switch (command) {
    case hmi::Command::Start:
    case hmi::Command::Resume:
      if (now == Mode::EmergencyStop || now == Mode::Fault)
        return hmi::Reply::refused("confirm-first", "look around the vehicle and confirm first");
      if (now == Mode::Manual) say(OperatorWord::ManualOff);
      say(OperatorWord::Resume);
      break;
    case hmi::Command::Pause:
      say(OperatorWord::Pause);
      break;
    case hmi::Command::Stop: {
      say(OperatorWord::Pause);
      const std::scoped_lock lock(store_mutex_);
      for (const auto& order : store_.list(true))
        if (order.state == OrderState::Running)
          store_.close(order.id, OrderState::Cancelled, "stopped at the panel", wall_clock());
      break;
    }
    case hmi::Command::Confirm:
      say(OperatorWord::Confirm);
      break;
  }
  return hmi::Reply::done();
}

hmi::Reply PanelVehicle::jog(const VelocityCommand& velocity) {
  const Mode now = mode();
  if (now == Mode::EmergencyStop || now == Mode::Fault)
    return hmi::Reply::refused("confirm-first", "look around the vehicle and confirm first");
  const bool stands = velocity == VelocityCommand{};
  if (now != Mode::Manual && stands) return hmi::Reply::done();
  if (now != Mode::Manual) run_.say({OperatorWord::ManualOn, {}});
  run_.say({OperatorWord::Jog, velocity});
  return hmi::Reply::done();
}

std::vector<hmi::OrderView> PanelVehicle::orders() const {
  const std::scoped_lock lock(store_mutex_);
  std::vector<hmi::OrderView> list;
  for (const auto& order : store_.list(true)) {
    hmi::OrderView view;
    view.id = order.id;
    for (const auto& stop : order.stops) view.stations.push_back(stop.node);
    view.status = to_string(order.state);
    view.repeat = order.repeat;
    view.detail = plain(order.note);
    list.push_back(std::move(view));
  }
  return list;
}

hmi::Reply PanelVehicle::add_order(const std::vector<int>& stations, int repeat) {
  if (stations.empty()) return hmi::Reply::refused("empty-order", "choose at least one station");
  if (repeat < 1 || repeat > kMostRepeats) return hmi::Reply::refused("bad-repeat", "repeat 1 to 1000 times");
  std::vector<OrderStop> stops;
  for (const int station : stations) {
    if (!run_.config().routes.index_of(station))
      return hmi::Reply::refused("unknown-station",
                                 "station " + std::to_string(station) + " is not in the routes");
    stops.push_back({station, StopAction::Pass, 0.0});
  }
  const std::scoped_lock lock(store_mutex_);
  store_.add(stops, repeat, wall_clock());
  return hmi::Reply::done();
}

hmi::Reply PanelVehicle::cancel_order(long long id) {
  const std::scoped_lock lock(store_mutex_);
  const auto order = store_.find(id);
  if (!order || (order->state != OrderState::Queued && order->state != OrderState::Running))
    return hmi::Reply::refused("no-order", "there is no such open order");
  store_.close(id, OrderState::Cancelled, "cancelled at the panel", wall_clock());
  return hmi::Reply::done();
}

std::vector<hmi::EventView> PanelVehicle::events(std::size_t newest) const {
  const std::scoped_lock lock(store_mutex_);
  std::vector<hmi::EventView> list;
  for (const auto& event : store_.events(newest))
    list.push_back({event.stamp, event.kind == "device" ? "warning" : "info", plain(event.text), {}});
  return list;
}

hmi::StatisticsView PanelVehicle::statistics() const {
  const std::scoped_lock lock(store_mutex_);
  return {store_.stops_done()};
}

/// The cycle's map and routes are fixed while it runs; what was edited counts from the next start.
hmi::Reply PanelVehicle::reload_site() {
  return hmi::Reply::refused("restart-needed", "what was changed counts when the vehicle is started again");
}

}  // namespace madori::app
