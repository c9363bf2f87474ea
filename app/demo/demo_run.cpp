#include "app/demo/demo_run.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <numeric>

#include "app/cycle/site_config.hpp"
#include "app/demo/played_operator.hpp"
#include "app/pose/localizer_pose.hpp"
#include "app/recording/recorder.hpp"
#include "app/runner/real_time.hpp"
#include "app/runner/site_lock.hpp"
#include "app/runner/socket_link.hpp"
#include "app/simulated/live_factory.hpp"
#include "core/clock.hpp"
#include "core/segment_distance.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::uintmax_t kMostRecording_bytes = 400'000'000;
constexpr double kMovingMps = 0.01;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

simulation::FactorySetup setup_of(const DemoOptions& options) {
  auto setup = simulation::load_setup(options.site, options.scenario);
  setup.epoch = clock_now();
  return setup;
}

double distance_from(const std::vector<PathPoint>& path, const Point2<Map>& at) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
    nearest_m = std::min(nearest_m, distance_m(Segment2<Map>{path[i].position, path[i + 1].position}, at));
  return nearest_m;
}

/// Looks on while the vehicle works, and fills the result.
class Observer {
 public:
  Observer(DemoResult& result, const CycleConfig& config, const LiveFactory& factory)
      : result_(result), config_(config), factory_(factory) {}

  void begin_order(int node) {
    const auto& routes = config_.routes.nodes();
    const auto index = config_.routes.index_of(node);
    result_.deliveries.push_back({node, index ? routes[*index].name : "", false, 0.0, 0.0, 0.0, 0.0});
    begun_ = Clock::now();
  }
  void look(const CycleOutput& output, const CycleState& state) {
    const auto truth = factory_.truth();
    const Point2<Map> here = truth.map_from_base.translation();
    if (result_.localized_after_s < 0.0 && state.pose.health.state == LocalizationState::Localized)
      result_.localized_after_s = seconds_since(started_);
    result_.events.insert(result_.events.end(), output.events.begin(), output.events.end());
    auto& delivery = result_.deliveries.back();
    if (!result_.driven.empty()) delivery.way_m += distance_m(result_.driven.back(), here);
    if (state.mode == Mode::Waiting && !state.errand.arrived) delivery.waited_s += 0.02;
    if (state.mode == Mode::Driving && !state.errand.arrived)
      off_route_m_.push_back(distance_from(state.way.path.points(), here));
    result_.driven.push_back(here);
    result_.believed.push_back(state.pose.map_from_base.translation());
  }
  void end_order(bool delivered) {
    auto& delivery = result_.deliveries.back();
    delivery.delivered = delivered;
    delivery.time_s = seconds_since(begun_);
    const auto index = config_.routes.index_of(delivery.node);
    if (index)
      delivery.goal_error_m =
          distance_m(factory_.truth().map_from_base.translation(), config_.routes.nodes()[*index].position);
  }
  void finish() {
    if (!off_route_m_.empty()) {
      result_.route_mean_m = std::accumulate(off_route_m_.begin(), off_route_m_.end(), 0.0) /
                             static_cast<double>(off_route_m_.size());
      result_.route_max_m = *std::max_element(off_route_m_.begin(), off_route_m_.end());
    }
    for (const auto& collision : factory_.collisions())
      result_.collisions += collision.speed_mps >= kMovingMps;
    result_.wall_s = seconds_since(started_);
  }

 private:
  DemoResult& result_;
  const CycleConfig& config_;
  const LiveFactory& factory_;
  Clock::time_point started_ = Clock::now();
  Clock::time_point begun_{};
  std::vector<double> off_route_m_;
};

}  // namespace

bool DemoResult::all_delivered() const {
  return !deliveries.empty() &&
         std::all_of(deliveries.begin(), deliveries.end(), [](const auto& d) { return d.delivered; });
}

DemoResult run_demo(const DemoOptions& options) {
  const SiteLock lock(options.site);
  auto loaded = load_for_driving(options.site);
  const fs::path devices = options.site / "devices";
  fs::create_directories(devices);
  LiveFactory factory(setup_of(options), devices);
  SocketOptions sockets;
  sockets.lidar_address = "127.0.0.1";
  sockets.lidar_port = sockets.lidar_position_port = 0;
  sockets.drive_device = (devices / "drive").string();
  auto link = std::make_unique<SocketLink>(sockets, loaded.config.odometry.wheels, factory.served());
  factory.send_to(link->lidar_port());
  auto source = std::make_unique<LocalizerPose>(loaded.walls, loaded.config.lidars);
  TransportRun run(loaded.config, std::move(source), std::move(link),
                   {.site = options.site, .store_poll_s = 0.1});
  OrderStore orders(options.site / "madori.db");
  for (const Order& order : orders.list(true))
    orders.close(order.id, OrderState::Cancelled, "left over from an earlier demo", time_of_day());
  DemoResult result;
  Observer observer(result, run.config(), factory);
  fs::remove_all(options.site / "runs/demo");
  Recorder recorder(options.site / "runs/demo",
                    {.lidars = run.config().lidars, .room = {.max_bytes = kMostRecording_bytes}});
  PlayedOperator person;
  run.set_tap([&](const auto& in, const auto& out, const auto& state) {
    recorder.add(in, out, state);
    observer.look(out, state);
  });
  run.say({OperatorWord::Resume, {}});
  const auto begun = Clock::now();
  const std::atomic<bool> never = false;
  for (const int node : options.stations) {
    observer.begin_order(node);
    const auto id = orders.add({{node, StopAction::Unload, 1.0}}, 1, time_of_day());
    bool delivered = false;
    const auto done = [&] {
      for (const OperatorWord word : person.look(run.view().mode, run.view().now)) run.say({word, {}});
      const auto order = run.view().order;
      delivered = order && order->id == id && order->state == OrderState::Done;
      return delivered || seconds_since(begun) > options.limit_s;
    };
    run_in_real_time([&](Stamp now) { run.tick(now); }, never,
                     {.done = done, .told = [&](const std::string& text) { run.tell(text); }});
    observer.end_order(delivered);
    if (!delivered) break;
  }
  observer.finish();
  result.confirmed = person.confirmed();
  return result;
}

}  // namespace madori::app
