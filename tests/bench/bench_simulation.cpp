// A VLP-16 revolution in a factory of 20,000 triangles, and lock-step simulation against real time.
// Run: build/release/tests/bench/bench_simulation   (one core; figures in docs/reference/simulation.md)
#include <benchmark/benchmark.h>

#include "simulation/factory.hpp"
#include "tests/support/receiver.hpp"

namespace {

using namespace madori::simulation;  // NOLINT: a bench of one room
using std::chrono::milliseconds;

/// An 80 m x 50 m hall full of shelves and machines, 20,000 triangles, and six movers.
FactorySetup large_factory(bool movers) {
  FactorySetup setup;
  const auto wall = [&](double x1, double y1, double x2, double y2) {
    setup.walls.push_back({static_cast<int>(setup.walls.size()) + 1, {{x1, y1}, {x2, y2}}});
  };
  wall(0, 0, 80, 0), wall(80, 0, 80, 50), wall(80, 50, 0, 50), wall(0, 50, 0, 0);
  Scenario& s = setup.scenario;
  s.name = "bench";
  s.start = {4.0, 25.0, 0.0};
  Random random(1, 0, 0);
  const auto in_hall = [&](double reach) {
    return madori::Point2<Plan>{random.uniform(reach, 80 - reach), random.uniform(reach, 50 - reach)};
  };
  while (setup.walls.size() < 1000) {  // partitions and columns
    const auto p = in_hall(2.0);
    if (std::abs(p.y_m - 25.0) < 3.0) continue;
    wall(p.x_m, p.y_m, p.x_m + random.uniform(-1.5, 1.5), p.y_m + random.uniform(-1.5, 1.5));
  }
  while (s.solids.size() < 1810) {  // ten triangles each
    const auto p = in_hall(1.0);
    if (std::abs(p.y_m - 25.0) < 3.0) continue;
    s.solids.push_back({SolidKind::Machine, "machine", p, random.uniform(0, 90), random.uniform(0.1, 0.8),
                        random.uniform(0.1, 0.8), random.uniform(0.2, 2.2)});
  }
  for (int i = 0; movers && i < 6; ++i) {
    MoverSpec m;
    m.name = "person";
    m.path = {{10.0 + 8.0 * i, 22.5}, {14.0 + 8.0 * i, 27.5}};
    s.movers.push_back(m);
  }
  return setup;
}

/// One revolution: 1808 firings of 16 beams in packets of 24, at least 28,800 rays.
void vlp16_revolution(benchmark::State& state) {
  const FactorySetup setup = large_factory(true);
  const World world(setup.walls, setup.scenario);
  PoseTrack track;
  const auto pose = world.frames().building_pose(setup.scenario.map_from_plan * setup.scenario.start);
  track.add(madori::Duration(0), pose);
  track.add(std::chrono::hours(24), pose);
  std::vector<Body> bodies;
  for (const auto& m : setup.scenario.movers) bodies.push_back(Mover(m, world.frames()).body());
  const madori::mapping::SensorRecord top{"top", "vlp16", 0.0, 0.0, 1.2, 0.0};
  Vlp16Model lidar(top, setup.scenario.vlp16, 1, madori::Duration(0));
  for (auto _ : state)
    for (int packet = 0; packet < 75; ++packet)
      benchmark::DoNotOptimize(lidar.measure(View{world, track, bodies}));
  state.counters["rays"] = 75 * 24 * 16;
  state.counters["triangles"] = static_cast<double>(world.rays().triangles());
}
BENCHMARK(vlp16_revolution)->Unit(benchmark::kMillisecond);

/// One simulated second of vehicle and VLP-16, bytes and all; `decode`: with the decoder on the other side.
void lock_step(benchmark::State& state, bool decode, bool all_sensors, int keep_every_firing) {
  FactorySetup setup = large_factory(true);
  setup.scenario.vlp16.keep_every_firing = keep_every_firing;
  if (!all_sensors) setup.sensors = {{"top", "vlp16", 0.3, 0.0, 1.2, 0.0}};
  Factory factory(setup);
  madori::test::Receiver receiver({});
  double turn = 0.3;
  for (auto _ : state) {
    for (int i = 0; i < 20; ++i) {
      factory.step(milliseconds(50), {4.0 - turn, 4.0 + turn});
      const auto packets = factory.take_packets();
      if (decode) receiver.push(packets);
      receiver.clouds.clear(), receiver.odometry.clear();
      receiver.lms_scans.clear(), receiver.s300_scans.clear();
    }
    turn = -turn;
  }
  state.counters["x_real_time"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["triangles"] = static_cast<double>(factory.world().rays().triangles());
}
BENCHMARK_CAPTURE(lock_step, vehicle_and_vlp16, false, false, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(lock_step, vehicle_and_vlp16_decoded, true, false, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(lock_step, all_sensors_decoded, true, true, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(lock_step, every_fourth_firing_decoded, true, false, 4)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
