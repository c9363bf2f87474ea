// A 540-point scan from 0.3 m and 5 degrees off in a 100 m x 60 m hall, forty times; and the search of the
// whole map. Peers from Debian packages in the same run: PCL's ICP and NDT on the map's points.
#include <benchmark/benchmark.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/ndt.h>

#include "localization/global/global_localizer.hpp"
#include "localization/ndt_map/map_registration.hpp"
#include "localization/registration/point_icp.hpp"
#include "tests/bench/registration_trials.hpp"

namespace madori::bench {
namespace {

using namespace madori::localization;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

BENCHMARK(point_to_segment_icp)->Unit(benchmark::kMillisecond);

void point_to_point_icp(benchmark::State& state) {
  const PointMap map(sample_walls(hall(), 0.05));
  forty_times(state, [&](const Task& t) { return point_icp(t.scan, map, t.start).map_from_base; });
}
BENCHMARK(point_to_point_icp)->Unit(benchmark::kMillisecond);

/// Gaussians on Gaussians, as `madori evaluate --map` lays maps on each other.
void ndt_to_ndt(benchmark::State& state) {
  const GaussianPyramid map(sample_walls(hall(), 0.05), 0.25);
  forty_times(state, [&](const Task& t) {
    const Transform2<Map, Map> guess(t.start.x_m(), t.start.y_m(), t.start.yaw_rad());
    return lay_on(map, GaussianPyramid(t.scan, 0.25), guess).pose();
  });
}
BENCHMARK(ndt_to_ndt)->Unit(benchmark::kMillisecond);

/// The map's points; with `jitter_m`, because PCL's NDT fails on mathematically flat walls.
Cloud::Ptr map_cloud(double jitter_m) {
  auto cloud = std::make_shared<Cloud>();
  std::mt19937 engine(1);
  std::normal_distribution<double> n(0.0, 1.0);
  for (const Point2<Map>& p : sample_walls(hall(), 0.05))
    cloud->emplace_back(static_cast<float>(p.x_m + jitter_m * n(engine)),
                        static_cast<float>(p.y_m + jitter_m * n(engine)),
                        static_cast<float>(jitter_m * n(engine)));
  return cloud;
}

template <class Registration>
Pose run_pcl(Registration& registration, const Task& task) {
  auto source = std::make_shared<Cloud>();
  for (std::size_t i = 0; i < task.scan.size(); ++i)
    source->emplace_back(task.scan.x_m[i], task.scan.y_m[i], 0.0F);
  Eigen::Matrix4f guess = Eigen::Matrix4f::Identity();
  guess(0, 0) = guess(1, 1) = static_cast<float>(task.start.cos_yaw());
  guess(1, 0) = static_cast<float>(task.start.sin_yaw());
  guess(0, 1) = -guess(1, 0);
  guess(0, 3) = static_cast<float>(task.start.x_m());
  guess(1, 3) = static_cast<float>(task.start.y_m());
  registration.setInputSource(source);
  Cloud aligned;
  registration.align(aligned, guess);
  const Eigen::Matrix4f t = registration.getFinalTransformation();
  return {t(0, 3), t(1, 3), std::atan2(t(1, 0), t(0, 0))};
}

void peer_pcl_icp(benchmark::State& state) {
  pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
  icp.setInputTarget(map_cloud(0.0));
  icp.setMaxCorrespondenceDistance(0.5);
  icp.setMaximumIterations(50);
  icp.setTransformationEpsilon(1e-8);
  forty_times(state, [&](const Task& t) { return run_pcl(icp, t); });
}
BENCHMARK(peer_pcl_icp)->Unit(benchmark::kMillisecond)->Iterations(1);

void peer_pcl_ndt(benchmark::State& state) {
  pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ> peer;
  peer.setResolution(1.0F);
  peer.setStepSize(0.1);
  peer.setTransformationEpsilon(1e-6);
  peer.setMaximumIterations(35);
  peer.setInputTarget(map_cloud(0.01));
  forty_times(state, [&](const Task& t) { return run_pcl(peer, t); });
}
BENCHMARK(peer_pcl_ndt)->Unit(benchmark::kMillisecond)->Iterations(1);

void whole_map_search(benchmark::State& state) {
  const GlobalLocalizer global(hall());
  int found = 0;
  forty_times(state, [&](const Task& t) {
    const GlobalAnswer answer = global.locate(t.scan);
    found += answer.state == GlobalState::Found;
    return answer.hypotheses.front().fit.map_from_base;
  });
  state.counters["share_found"] = found / (40.0 * static_cast<double>(state.iterations()));
}
BENCHMARK(whole_map_search)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace madori::bench

BENCHMARK_MAIN();
