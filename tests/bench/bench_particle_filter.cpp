// Sensor update per particle and beam, beside the bare loads of the same places of the same table; motion
// per particle. One core; `--benchmark_repetitions=5` for a spread.
#include <benchmark/benchmark.h>

#include "localization/particle_filter/motion_kernel.hpp"
#include "localization/particle_filter/sensor_kernel.hpp"
#include "tests/bench/localization_scene.hpp"

namespace madori::bench {
namespace {

using namespace madori::localization;

struct Scene {
  mapping::Walls walls = hall_100_by_60();
  mapping::DistanceField distance{walls};
  LikelihoodField field{walls, BeamModel{}};
  std::mt19937 engine{7};
  Pose truth = pose_on_the_floor(walls, distance, engine);
  BeamBlocks beams{scan_540(walls, truth, engine), field};

  Particles particles(bool tracking) {
    Particles p;
    p.origin = field.frame().origin;
    std::normal_distribution<double> n(0.0, 1.0);
    for (int i = 0; i < (tracking ? 1000 : 10'000); ++i) {
      const Pose pose = tracking ? Pose(truth.x_m() + 0.1 * n(engine), truth.y_m() + 0.1 * n(engine),
                                        truth.yaw_rad() + 0.03 * n(engine))
                                 : test::random_pose(walls, distance, 0.3, 3.0, engine);
      p.add(pose);
    }
    return p;
  }
};

Scene& scene() {
  static Scene the_scene;
  return the_scene;
}
const Particles& particles(bool tracking) {
  static const Particles near = scene().particles(true);
  static const Particles all_over = scene().particles(false);
  return tracking ? near : all_over;
}

/// Seconds of one particle and beam.
void per_particle_beam(benchmark::State& state, std::size_t count) {
  state.counters["per_particle_beam"] =
      benchmark::Counter(static_cast<double>(count * scene().beams.beams()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void sensor_kernel(benchmark::State& state) {
  const Particles& p = particles(state.range(0) != 0);
  std::vector<std::uint32_t> sums(p.size());
  for (auto _ : state) {
    sum_counts(p, scene().beams, scene().field, sums);
    benchmark::DoNotOptimize(sums.data());
  }
  per_particle_beam(state, p.size());
}
BENCHMARK(sensor_kernel)->ArgName("tracking")->Arg(1)->Arg(0);

/// The load limit: where to look is known beforehand, only the looking is left.
void bare_loads(benchmark::State& state) {
  const Particles& p = particles(state.range(0) != 0);
  const mapping::GridFrame& frame = scene().field.frame();
  const double unit = frame.cell_m / (1 << scene().beams.fraction_bits());
  std::vector<std::int32_t> places;
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t k = 0; k < scene().beams.beams(); ++k) {
      const Point2<Map> q =
          p.pose(i) * Point2<Base>{scene().beams.x()[k] * unit, scene().beams.y()[k] * unit};
      const int column =
          std::clamp(static_cast<int>((q.x_m - frame.origin.x_m) / frame.cell_m), 0, frame.width - 1);
      const int row =
          std::clamp(static_cast<int>((q.y_m - frame.origin.y_m) / frame.cell_m), 0, frame.height - 1);
      places.push_back(row * frame.width + column);
    }
  const std::uint8_t* table = scene().field.table().data();
  for (auto _ : state) {
    std::uint32_t a = 0, b = 0, c = 0, d = 0;
    for (std::size_t i = 0; i + 4 <= places.size(); i += 4) {
      a += table[places[i]];
      b += table[places[i + 1]];
      c += table[places[i + 2]];
      d += table[places[i + 3]];
    }
    benchmark::DoNotOptimize(a + b + c + d);
  }
  per_particle_beam(state, p.size());
}
BENCHMARK(bare_loads)->ArgName("tracking")->Arg(1)->Arg(0);

void motion(benchmark::State& state) {
  Particles p = particles(true);
  MotionStep step{{0.0F, 0.0F, 0.0F}, {0.01F, 0.0F, 0.01F, 0.0F, 0.0F, 0.01F}, 1, 2};
  for (auto _ : state) {
    ++step.key1;
    move_particles(step, p.x_m.data(), p.y_m.data(), p.yaw_rad.data(), p.size());
    benchmark::DoNotOptimize(p.x_m.data());
  }
  state.counters["per_particle"] =
      benchmark::Counter(static_cast<double>(p.size()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(motion);

}  // namespace
}  // namespace madori::bench

BENCHMARK_MAIN();
