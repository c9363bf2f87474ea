// Deliveries in the virtual factory, lock-step, with real localization: what is measured stands in
// docs/reference/ driving-figures.md with the command. Not part of ctest. Exit 1 where an order was not
// delivered or the vehicle ran into something.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "app/cycle/site_config.hpp"
#include "app/json_output.hpp"
#include "app/pose/drawing_pose.hpp"
#include "app/runner/transport_run.hpp"
#include "app/simulated/factory_link.hpp"
#include "core/segment_distance.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(20);

struct Arguments {
  std::string site;
  std::string scenario;
  int orders = 10;
  int day = 0;
  unsigned seed = 1;
  double limit_s = 600.0;
  int kidnappings = 0;
  int dropouts = 0;
  std::string json_file;
  bool verbose = false;
};

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}
double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

struct Figures {
  int delivered = 0;
  int undelivered = 0;
  std::vector<double>
      off_route_m;  ///< the true Base origin from the planned path, while driving on the route
  std::vector<double> pose_error_m;  ///< while localized
  std::vector<double> goal_error_m;
  std::vector<double> goal_error_rad;
  std::vector<double> step_ms;
  std::map<std::string, double> standstill_s;
  int moving_collisions = 0;
  int standing_collisions = 0;
};

/// How far the point lies from the path, near the place where the cycle believes to be.
double distance_from_path(const app::Navigation& way, const Point2<Map>& at) {
  const auto& points = way.path.points();
  double best = 1e9;
  const std::size_t from = way.pursuit.index > 30 ? way.pursuit.index - 30 : 0;
  for (std::size_t i = from; i + 1 < points.size() && i < way.pursuit.index + 30; ++i)
    best = std::min(best, distance_m(Segment2<Map>{points[i].position, points[i + 1].position}, at));
  return best;
}

class Soak {
 public:
  explicit Soak(const Arguments& arguments)
      : arguments_(arguments), loaded_(app::load_for_driving(arguments.site)), random_(arguments.seed) {
    auto setup = simulation::load_setup(arguments.site, arguments.scenario);
    setup.scenario.furniture.day = arguments.day;
    setup.seed = arguments.seed;
    factory_ = std::make_shared<simulation::Factory>(setup);
    app::TransportOptions options;
    options.site = database_.path();
    options.detours_in_step = true;
    options.store_poll_s = 0.1;
    run_ = std::make_unique<app::TransportRun>(
        loaded_.config, std::make_unique<app::DrawingPose>(loaded_.walls),
        std::make_unique<app::FactoryLink>(factory_, loaded_.config.odometry.wheels, kStep), options);
    run_->set_tap([this](const auto& in, const auto& out, const auto& state) { observe(in, out, state); });
    run_->say({app::OperatorWord::Resume, {}});
  }

  Figures work() {
    std::vector<int> stations;
    for (const auto& node : loaded_.config.routes.nodes())
      if (node.station && !loaded_.config.routes.legs_from(*loaded_.config.routes.index_of(node.id)).empty())
        stations.push_back(node.id);
    for (int i = 0; i < arguments_.orders; ++i) {
      int next = last_;
      while (next == last_) next = stations[random_() % stations.size()];
      last_ = next;
      deliver(next);
    }
    for (const auto& c : factory_->collisions()) {
      const bool moving = c.speed_mps >= 0.01;
      ++(moving ? figures_.moving_collisions : figures_.standing_collisions);
      std::printf("collision at %.1f s with %s, vehicle at %.2f m/s\n", to_seconds(c.stamp - begun_),
                  c.what.c_str(), c.speed_mps);
    }
    return figures_;
  }
  [[nodiscard]] double driven_m() const { return factory_->distance_driven_m(); }
  [[nodiscard]] double simulated_s() const { return to_seconds(factory_->now() - begun_); }

 private:
  void deliver(int node) {
    const auto id = run_->orders().add({{node, app::StopAction::Pass, 0.0}}, 1, factory_->now());
    const Stamp began = factory_->now();
    const bool kidnap = arguments_.kidnappings > 0 && random_() % static_cast<unsigned>(arguments_.orders) <
                                                          static_cast<unsigned>(arguments_.kidnappings);
    const bool dropout = arguments_.dropouts > 0 && random_() % static_cast<unsigned>(arguments_.orders) <
                                                        static_cast<unsigned>(arguments_.dropouts);
    if (dropout) {
      simulation::FaultSpec silence;
      silence.device = simulation::Device::Vlp16;
      silence.at_s = 5.0;
      silence.for_s = 3.0;
      factory_->inject(silence);
    }
    bool kidnapped = !kidnap;
    while (to_seconds(factory_->now() - began) < arguments_.limit_s) {
      tick();
      if (!kidnapped && to_seconds(factory_->now() - began) > 8.0) {
        kidnapped = true;
        carry_away();
      }
      const auto state = run_->orders().find(id);
      if (ticks_ % 25 != 0) continue;
      if (state->state == app::OrderState::Done) return delivered(node, began);
      if (state->state != app::OrderState::Running && state->state != app::OrderState::Queued) break;
    }
    ++figures_.undelivered;
    const auto truth = factory_->truth().map_from_base;
    std::printf("order %ld to node %d NOT delivered: %s: %s; at (%.2f, %.2f, %.0f deg), %s\n",
                static_cast<long>(id), node, to_string(run_->state().mode),
                run_->state().standstill.cause.text.c_str(), truth.x_m(), truth.y_m(),
                to_deg(truth.yaw_rad()), run_->state().pose.health.reason.c_str());
    run_->orders().close(id, app::OrderState::Cancelled, "soak: not delivered in time", factory_->now());
  }

  void delivered(int node, Stamp began) {
    ++figures_.delivered;
    const auto& goal = loaded_.config.routes.nodes()[*loaded_.config.routes.index_of(node)];
    const auto truth = factory_->truth().map_from_base;
    figures_.goal_error_m.push_back(distance_m(truth.translation(), goal.position));
    if (goal.heading_rad)
      figures_.goal_error_rad.push_back(std::abs(wrap_angle(truth.yaw_rad() - *goal.heading_rad)));
    if (arguments_.verbose)
      std::printf("%3d to %2d in %5.1f s, %.3f m, %.2f deg\n", figures_.delivered, node,
                  to_seconds(factory_->now() - began), figures_.goal_error_m.back(),
                  goal.heading_rad ? to_deg(figures_.goal_error_rad.back()) : 0.0);
  }

  /// To another node of the routes, another way round.
  void carry_away() {
    const auto& nodes = loaded_.config.routes.nodes();
    const auto& node = nodes[random_() % nodes.size()];
    factory_->set_pose({node.position.x_m, node.position.y_m, static_cast<double>(random_() % 628) / 100.0});
  }

  void tick() {
    ++ticks_;
    const auto before = std::chrono::steady_clock::now();
    run_->tick(factory_->now() + kStep);
    figures_.step_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - before).count());
  }

  void observe(const app::CycleInput& input, const app::CycleOutput& output, const app::CycleState& state) {
    const auto truth = factory_->truth().map_from_base;
    if (state.mode == app::Mode::Driving && !state.way.path.empty() && !state.way.arrived)
      figures_.off_route_m.push_back(distance_from_path(state.way, truth.translation()));
    if (state.pose.health.state == LocalizationState::Localized)
      figures_.pose_error_m.push_back(
          distance_m(truth.translation(), state.pose.map_from_base.translation()));
    if (!app::drives(state.mode)) figures_.standstill_s[state.standstill.cause.text] += to_seconds(kStep);
    if (!arguments_.verbose) return;
    for (const auto& event : output.events)
      std::printf("%8.2f  %s  (%.2f, %.2f)\n", to_seconds(input.now - begun_), event.c_str(), truth.x_m(),
                  truth.y_m());
  }

  Arguments arguments_;
  app::SiteForDriving loaded_;
  std::mt19937 random_;
  test::TemporaryFolder database_;
  std::shared_ptr<simulation::Factory> factory_;
  std::unique_ptr<app::TransportRun> run_;
  Figures figures_;
  Stamp begun_ = Stamp(std::chrono::seconds(1'767'225'600));
  int last_ = -1;
  std::uint64_t ticks_ = 0;
};

int run(const Arguments& arguments) {
  const auto before = std::chrono::steady_clock::now();
  Soak soak(arguments);
  const Figures f = soak.work();
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  const auto close =
      std::count_if(f.goal_error_m.begin(), f.goal_error_m.end(), [](double e) { return e <= 0.02; });
  const auto straight = std::count_if(f.goal_error_rad.begin(), f.goal_error_rad.end(),
                                      [](double e) { return e <= to_rad(1.0); });
  std::printf("delivered %d, not %d; %.0f m in %.0f s (%.1f x real time)\n", f.delivered, f.undelivered,
              soak.driven_m(), soak.simulated_s(), soak.simulated_s() / wall_s);
  std::printf("from the route: mean %.4f m, p99 %.4f m, most %.4f m\n", mean(f.off_route_m),
              percentile(f.off_route_m, 0.99), percentile(f.off_route_m, 1.0));
  std::printf("pose while localized: mean %.4f m, p99 %.4f m, most %.4f m\n", mean(f.pose_error_m),
              percentile(f.pose_error_m, 0.99), percentile(f.pose_error_m, 1.0));
  std::printf("goal: %ld of %zu within 0.02 m (p95 %.4f m), %ld of %zu within 1 deg (p95 %.2f deg)\n",
              static_cast<long>(close), f.goal_error_m.size(), percentile(f.goal_error_m, 0.95),
              static_cast<long>(straight), f.goal_error_rad.size(),
              to_deg(percentile(f.goal_error_rad, 0.95)));
  std::printf("collisions: %d while moving, %d while standing\n", f.moving_collisions, f.standing_collisions);
  for (const auto& [cause, seconds] : f.standstill_s)
    std::printf("stood %7.1f s: %s\n", seconds, cause.c_str());
  app::write_json(arguments.json_file, {{"delivered", f.delivered},
                                        {"undelivered", f.undelivered},
                                        {"driven_m", soak.driven_m()},
                                        {"simulated_s", soak.simulated_s()},
                                        {"wall_s", wall_s},
                                        {"off_route_mean_m", mean(f.off_route_m)},
                                        {"off_route_max_m", percentile(f.off_route_m, 1.0)},
                                        {"goal_within_2cm", close},
                                        {"goal_within_1deg", straight},
                                        {"moving_collisions", f.moving_collisions},
                                        {"standing_collisions", f.standing_collisions}});
  return f.undelivered == 0 && f.moving_collisions == 0 ? 0 : 1;
}

}  // namespace
}  // namespace madori

int main(int argc, char** argv) {
  CLI::App app("Deliveries in the virtual factory, lock-step");
  madori::Arguments arguments;
  app.add_option("SITE", arguments.site, "site folder with routes")->required();
  app.add_option("SCENARIO", arguments.scenario, "scenario file")->required();
  app.add_option("--orders", arguments.orders, "deliveries");
  app.add_option("--day", arguments.day, "which arrangement of what stands elsewhere every day");
  app.add_option("--seed", arguments.seed, "of everything left to chance");
  app.add_option("--limit", arguments.limit_s, "seconds of factory time for one order");
  app.add_option("--kidnappings", arguments.kidnappings, "about so many, spread over the orders");
  app.add_option("--dropouts", arguments.dropouts, "the lidar falls silent for 3 s about so many times");
  app.add_option("--json", arguments.json_file, "the figures; - for stdout");
  app.add_flag("--verbose", arguments.verbose, "print every event and delivery");
  CLI11_PARSE(app, argc, argv);
  try {
    return madori::run(arguments);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "soak: %s\n", e.what());
    return 1;
  }
}
