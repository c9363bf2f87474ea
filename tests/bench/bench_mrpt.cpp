// MRPT as a peer, on the tasks of bench_registration and the scene of bench_particle_filter, beside ours in
// the same run. Built only where MRPT is installed (libmrpt-slam-dev, 59 packages: no part of
// cmake/packages.txt); the configuration says which.
#include <benchmark/benchmark.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/slam/CICP.h>

#include "localization/particle_filter/sensor_kernel.hpp"
#include "localization/registration/point_map.hpp"
#include "tests/bench/registration_trials.hpp"

namespace madori::bench {
namespace {

using namespace madori::localization;

BENCHMARK(point_to_segment_icp)->Unit(benchmark::kMillisecond);

void peer_mrpt_icp(benchmark::State& state, mrpt::slam::TICPAlgorithm algorithm) {
  mrpt::maps::CSimplePointsMap map;
  for (const Point2<Map>& p : sample_walls(hall(), 0.05))
    map.insertPoint(static_cast<float>(p.x_m), static_cast<float>(p.y_m), 0.0F);
  mrpt::slam::CICP icp;
  icp.options.ICP_algorithm = algorithm;
  icp.options.maxIterations = 80;
  icp.options.thresholdDist = 0.75;
  icp.options.thresholdAng = 0.1;
  forty_times(state, [&](const Task& t) {
    mrpt::maps::CSimplePointsMap scan;
    for (std::size_t i = 0; i < t.scan.size(); ++i) scan.insertPoint(t.scan.x_m[i], t.scan.y_m[i], 0.0F);
    const mrpt::poses::CPose2D start(t.start.x_m(), t.start.y_m(), t.start.yaw_rad());
    mrpt::poses::CPose2D found;
    icp.Align(&map, &scan, start)->getMean(found);
    return Pose(found.x(), found.y(), found.phi());
  });
}
BENCHMARK_CAPTURE(peer_mrpt_icp, classic, mrpt::slam::icpClassic)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);
BENCHMARK_CAPTURE(peer_mrpt_icp, levenberg_marquardt, mrpt::slam::icpLevenbergMarquardt)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

void per_particle_beam(benchmark::State& state, std::size_t particles, std::size_t beams) {
  state.counters["per_particle_beam"] =
      benchmark::Counter(static_cast<double>(particles * beams),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

std::vector<Pose> thousand_poses(const Pose& truth) {
  std::mt19937 engine(7);
  std::normal_distribution<double> n(0.0, 1.0);
  std::vector<Pose> poses;
  for (int i = 0; i < 1000; ++i)
    poses.emplace_back(truth.x_m() + 0.1 * n(engine), truth.y_m() + 0.1 * n(engine),
                       truth.yaw_rad() + 0.03 * n(engine));
  return poses;
}

void sensor_kernel_tracking(benchmark::State& state) {
  const LikelihoodField field(hall(), BeamModel{});
  const BeamBlocks beams(tasks()[0].scan, field);
  Particles particles;
  particles.origin = field.frame().origin;
  for (const Pose& pose : thousand_poses(tasks()[0].truth)) particles.add(pose);
  std::vector<std::uint32_t> sums(particles.size());
  for (auto _ : state) {
    sum_counts(particles, beams, field, sums);
    benchmark::DoNotOptimize(sums.data());
  }
  per_particle_beam(state, particles.size(), beams.beams());
}
BENCHMARK(sensor_kernel_tracking)->Unit(benchmark::kMillisecond);

/// MRPT's likelihood field (Thrun) on a grid of 5 cm, which it keeps precomputed.
void peer_mrpt_likelihood(benchmark::State& state) {
  mrpt::maps::COccupancyGridMap2D grid(-2.0F, 102.0F, -2.0F, 62.0F, 0.05F);
  grid.fill(0.9F);
  for (const Point2<Map>& p : sample_walls(hall(), 0.02))
    grid.setCell(grid.x2idx(static_cast<float>(p.x_m)), grid.y2idx(static_cast<float>(p.y_m)), 0.05F);
  grid.likelihoodOptions.likelihoodMethod = mrpt::maps::COccupancyGridMap2D::lmLikelihoodField_Thrun;
  grid.likelihoodOptions.LF_decimation = 1;
  grid.likelihoodOptions.LF_maxRange = 60.0F;
  grid.likelihoodOptions.enableLikelihoodCache = true;
  mrpt::maps::CSimplePointsMap scan;
  const ScanPoints& points = tasks()[0].scan;
  for (std::size_t i = 0; i < points.size(); ++i) scan.insertPoint(points.x_m[i], points.y_m[i], 0.0F);
  const std::vector<Pose> poses = thousand_poses(tasks()[0].truth);
  double sum = 0.0;
  for (auto _ : state) {
    for (const Pose& pose : poses) {
      const mrpt::poses::CPose2D at(pose.x_m(), pose.y_m(), pose.yaw_rad());
      sum += grid.computeLikelihoodField_Thrun(&scan, &at);
    }
    benchmark::DoNotOptimize(sum);
  }
  per_particle_beam(state, poses.size(), points.size());
}
BENCHMARK(peer_mrpt_likelihood)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace madori::bench

BENCHMARK_MAIN();
