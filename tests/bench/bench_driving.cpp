// The planning and control part of the cycle (localization is the test's true pose), and the route search.
//   cmake --build build/release --target bench_driving && build/release/tests/bench/bench_driving
// Wanted: cycle p99 <= 1 ms, search on 10,000 nodes <= 5 ms.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>

#include "planning/route_graph/route_csv.hpp"
#include "tests/support/toy_vehicle.hpp"

namespace madori {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

void print(const char* what, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  std::printf("%-34s median %.3f ms, p99 %.3f ms, most %.3f ms (%zu)\n", what, at(0.5), at(0.99), at(1.0),
              values.size());
}

/// A square grid of 100 x 100 nodes, every leg two-way.
planning::RouteGraph grid() {
  constexpr std::size_t kSide = 100;
  std::vector<planning::RouteNode> nodes(kSide * kSide);
  std::vector<planning::RouteLeg> legs;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.3, 0.3);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i].id = static_cast<int>(i);
    nodes[i].position = {static_cast<double>(i % kSide) + shift(random),
                         static_cast<double>(i / kSide) + shift(random)};
    const auto join = [&](std::size_t other) {
      legs.push_back({i, other, 0.0, 0});
      legs.push_back({other, i, 0.0, 0});
    };
    if (i % kSide + 1 < kSide) join(i + 1);
    if (i + kSide < nodes.size()) join(i + kSide);
  }
  return {std::move(nodes), std::move(legs)};
}

void bench_search() {
  const auto graph = grid();
  for (const auto metric : {planning::RouteMetric::Hops, planning::RouteMetric::Metres}) {
    std::vector<double> times;
    for (int i = 0; i < 100; ++i) {
      const auto begin = Clock::now();
      const auto route = planning::find_route(graph, 0, graph.nodes().size() - 1, metric);
      times.push_back(milliseconds_since(begin));
      if (!route || route.value().nodes.size() < 199) std::abort();
    }
    print(metric == planning::RouteMetric::Hops ? "search of 10,000 nodes, hops"
                                                : "search of 10,000 nodes, metres",
          times);
  }
}

/// A run past posts on both sides and around a pallet, with 28,800 rays a revolution; every step timed.
void bench_cycle() {
  auto config = test::toy_config(
      planning::parse_routes("ID,EDA\n0,1\n1,0 2\n2,1\n", "ID,x,y\n0,0,0\n1,30,0\n2,30,20\n").graph);
  test::ToyVehicle vehicle(config, {0.0, 0.0, 0.0});
  vehicle.lidar.azimuths = 1800;
  for (double x = 1.0; x < 28.0; x += 1.5)
    for (const double y : {-1.6, 1.9}) vehicle.lidar.posts.push_back({{x, y}, 0.2, 1.8});
  vehicle.lidar.bodies.push_back({{{12.0, -0.3}, {12.0, 0.3}}, 0.3, 0.4});
  vehicle.record = true;
  vehicle.drive_to({{2}});
  vehicle.say(app::OperatorWord::Resume);
  vehicle.run_until([&] { return vehicle.delivered(); }, 150.0);
  // Once more on the recorded inputs, so that the toy lidar is not in the time.
  app::CycleState state(config, std::make_unique<test::TruePose>(vehicle.rolling));
  std::vector<double> all;
  std::vector<double> with_scan;
  for (const auto& input : vehicle.inputs) {
    const auto begin = Clock::now();
    auto [after, output] = app::step(std::move(state), input, config);
    all.push_back(milliseconds_since(begin));
    if (!input.clouds.empty()) with_scan.push_back(all.back());
    state = std::move(after);
  }
  print("cycle step, all", all);
  print("cycle step with a revolution", with_scan);
}

}  // namespace
}  // namespace madori

int main() {
  madori::bench_search();
  madori::bench_cycle();
}
