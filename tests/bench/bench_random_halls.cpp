// Mapping in halls that nobody chose: 100 to 5,000 m², machines, columns, walls with doors, a scan of 270
// degrees in steps of half a degree every 0.6 m (0.5 Hz, 0.3 m/s), wheels wrong by 3 %, Gaussian noise of
// 0.01 to 0.3 m on x and y of every point. Hall i has its size and noise from i alone. For each method a
// line: share of the scans in the map, mean and largest distance of these from the truth after the way was
// laid rigidly on it, of ten places sought in the map those within 0.3 m and 3 degrees of the truth,
// processor time a scan.
//   bench_random_halls [--first I] [--count N] [--methods graph,slow-lidar,rbpf[,icp-slam,rbpf-slam]]
//   [--places]
// icp-slam and rbpf-slam are MRPT's, where it is installed (libmrpt-slam-dev, mrpt-common).
// plot_random_halls.py draws the lines.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "localization/global/scan_noise.hpp"
#include "localization/slam/graph_mapper.hpp"
#include "localization/slam/rbpf_mapper.hpp"
#include "localization/slam/slow_lidar_mapper.hpp"
#include "tests/support/made_up_drive.hpp"
#include "tests/support/random_hall.hpp"
#include "tests/support/rigid_fit.hpp"
#ifdef MADORI_WITH_MRPT
#include "tests/bench/mrpt_mappers.hpp"
#endif

namespace madori::bench {
namespace {

using namespace madori::localization;
using Pose = Transform2<Map, Base>;

/// One hall, driven through.
struct Drive {
  test::RandomHall hall;
  double noise_m = 0.0;
  double length_m = 0.0;
  std::vector<test::DriveMoment> moments;  ///< the scans' ranges without noise
  std::vector<ScanPoints> points;          ///< one for each moment with a scan, noisy
  std::vector<Pose> truth;                 ///< likewise
};

/// Where the scans of `Drive` lie; `scan` says which.
struct Mapped {
  std::vector<std::size_t> scan;
  std::vector<Pose> poses;
  double processor_s = 0.0;
};

/// The golden ratio's multiples spread sizes evenly however many halls are asked for.
Drive driven(unsigned index, std::mt19937& engine) {
  constexpr double kNoise[] = {0.01, 0.05, 0.1, 0.2, 0.3};
  Drive drive;
  drive.noise_m = kNoise[index % 5];
  const double share = std::fmod(0.6180339887 * index, 1.0);
  drive.hall = test::random_hall(100.0 * std::pow(50.0, share), engine);
  drive.moments = test::drive(drive.hall.walls, drive.hall.way, test::half_hertz(), engine);
  for (std::size_t i = 0; i < drive.moments.size(); ++i) {
    const test::DriveMoment& m = drive.moments[i];
    if (i > 0) drive.length_m += distance_m(drive.moments[i - 1].truth.translation(), m.truth.translation());
    if (!m.has_scan) continue;
    drive.points.push_back(test::noisy_points(m.scan, drive.noise_m, engine));
    drive.truth.push_back(m.truth);
  }
  return drive;
}

Mapped by_madori(const Drive& drive, const std::string& method) {
  std::unique_ptr<Mapper> mapper;
  if (method == "graph") mapper = std::make_unique<GraphMapper>();
  if (method == "slow-lidar") mapper = std::make_unique<SlowLidarMapper>();
  if (method == "rbpf") mapper = std::make_unique<RbpfMapper>();
  Mapped mapped;
  std::vector<Stamp> stamps;
  const std::clock_t before = std::clock();
  for (const auto& moment : drive.moments) {
    (void)mapper->on_odometry(moment.odometry);
    if (!moment.has_scan) continue;
    (void)mapper->on_scan(moment.scan.stamp, drive.points[stamps.size()], {});
    stamps.push_back(moment.scan.stamp);
  }
  for (const MomentPose& pose : mapper->finish().scans) {
    const auto at = std::lower_bound(stamps.begin(), stamps.end(), pose.stamp);
    if (at == stamps.end() || *at != pose.stamp) continue;
    mapped.scan.push_back(static_cast<std::size_t>(at - stamps.begin()));
    mapped.poses.push_back(pose.map_from_base);
  }
  mapped.processor_s = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  return mapped;
}

#ifdef MADORI_WITH_MRPT
/// The same points as ranges: a peer's scan has nothing else. Each return goes to the beam that it lies in.
LaserScan ranges_of(const ScanPoints& points, const LaserScan& like) {
  LaserScan scan = like;
  std::fill(scan.ranges_m.begin(), scan.ranges_m.end(), LaserScan::kNoReturn);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double bearing = std::atan2(points.y_m[i], points.x_m[i]);
    const auto beam = std::lround((bearing - scan.angle_min_rad) / scan.angle_step_rad);
    if (beam < 0 || beam >= static_cast<long>(scan.ranges_m.size())) continue;
    scan.ranges_m[static_cast<std::size_t>(beam)] = std::hypot(points.x_m[i], points.y_m[i]);
  }
  return scan;
}

Mapped by_peer(const Drive& drive, const std::string& name) {
  const auto mapper = peer_mapper(name);
  Mapped mapped;
  const std::clock_t before = std::clock();
  for (const auto& moment : drive.moments) {
    mapper->on_odometry(moment.odometry);
    if (!moment.has_scan) continue;
    mapper->on_scan(ranges_of(drive.points[mapped.scan.size()], moment.scan));
    mapped.scan.push_back(mapped.scan.size());
  }
  mapped.poses = mapper->way();
  mapped.processor_s = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  return mapped;
}
#endif

Mapped mapped_by(const Drive& drive, const std::string& method) {
#ifdef MADORI_WITH_MRPT
  if (method == "icp-slam" || method == "rbpf-slam") return by_peer(drive, method);
#endif
  return by_madori(drive, method);
}

/// Ten places that the drive did not choose, sought in the map by Algorithm 2 without a start.
int found_places(const Drive& drive, const Mapped& mapped, const Transform2<Map, Map>& truth_from_map) {
  constexpr double kRightM = 0.3;
  GrowingMap map;
  double noise_m = 0.0;
  for (const ScanPoints& scan : drive.points)
    noise_m += scan_noise_m(scan) / static_cast<double>(drive.points.size());
  for (std::size_t i = 0; i < mapped.scan.size(); ++i)
    map.add(drive.points[mapped.scan[i]], mapped.poses[i], {}, noise_m);
  StrategyOptions at = with_noise({}, noise_m);
  at.most_e_psr_m = std::clamp(noise_m, at.most_e_psr_m, 0.3);
  const GlobalViews views(map.points(), at);
  std::mt19937 engine(static_cast<unsigned>(drive.moments.size()));
  int right = 0;
  for (int i = 0; i < 10; ++i) {
    const Pose& near = drive.truth[engine() % drive.truth.size()];
    std::normal_distribution<double> away(0.0, 0.1);
    std::uniform_real_distribution<double> any(-kPi, kPi);
    const Pose place(near.x_m() + away(engine), near.y_m() + away(engine), any(engine));
    const ScanPoints scan =
        test::noisy_points(test::simulate_scan(drive.hall.walls, place, {}, engine), drive.noise_m, engine);
    const auto found = localize_absolutely(scan, map.points(), views, at);
    if (!found) continue;
    const Pose pose = truth_from_map * found->fit.map_from_base;
    right += distance_m(pose.translation(), place.translation()) < kRightM &&
             std::abs(wrap_angle(pose.yaw_rad() - place.yaw_rad())) < to_rad(3.0);
  }
  return right;
}

void report(unsigned index, const Drive& drive, const std::string& method, const Mapped& mapped,
            bool is_sought) {
  std::vector<Pose> truth;
  for (const std::size_t i : mapped.scan) truth.push_back(drive.truth[i]);
  const Transform2<Map, Map> truth_from_map = test::laid_on(mapped.poses, truth);
  double mean = 0.0, most = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double off = distance_m((truth_from_map * mapped.poses[i]).translation(), truth[i].translation());
    mean += off / static_cast<double>(truth.size());
    most = std::max(most, off);
  }
  const auto scans = static_cast<double>(drive.truth.size());
  std::printf("%u,%.0f,%.2f,%.0f,%zu,%s,%.4f,%.4f,%.4f,%d,%.2f\n", index, drive.hall.area_m2, drive.noise_m,
              drive.length_m, drive.truth.size(), method.c_str(),
              static_cast<double>(mapped.scan.size()) / scans, mean, most,
              is_sought ? found_places(drive, mapped, truth_from_map) : -1, 1e3 * mapped.processor_s / scans);
  std::fflush(stdout);
}

}  // namespace
}  // namespace madori::bench

int main(int argc, char** argv) {
  unsigned first = 0, count = 50;
  std::vector<std::string> methods{"graph", "slow-lidar", "rbpf"};
  bool is_sought = false;
  CLI::App line;
  line.add_option("--first", first);
  line.add_option("--count", count);
  line.add_option("--methods", methods)->delimiter(',');
  line.add_flag("--places", is_sought, "seek ten places in each map");
  CLI11_PARSE(line, argc, argv);
  std::printf(
      "hall,area_m2,noise_m,driven_m,scans,method,in_map,mean_off_m,most_off_m,places_of_10,ms_per_scan\n");
  for (unsigned i = first; i < first + count; ++i) {
    std::mt19937 engine(1000 + i);
    const madori::bench::Drive drive = madori::bench::driven(i, engine);
    for (const std::string& method : methods)
      madori::bench::report(i, drive, method, madori::bench::mapped_by(drive, method), is_sought);
  }
}
