// Table 2 of Kis, Csemesz, Csáji (2021) on recorded logs: two sets of scans, each at 0.5 Hz at most, that
// take turns (where the log is slower than 1 Hz: every second of its scans). The map is made of one, the
// other's are sought in it by Algorithm 2 without any start, with candidates 0.2, 0.5 and 0.8 m apart. Two
// counts of success: within 0.3 m of the reference after the map was laid rigidly on it, and within 0.3 m of
// where the map itself has the place (the nearest scan of the map, and the reference's motion from there).
// `bench_slow_logs FOLDER [log[,log] [graph|slow-lidar [g [n]]]]`; n: every n-th of the scans that are sought
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>

#include "app/trajectory_file.hpp"
#include "core/stamp.hpp"
#include "localization/global/scan_noise.hpp"
#include "localization/slam/graph_mapper.hpp"
#include "localization/slam/slow_lidar_mapper.hpp"
#include "sensors/carmen/reader.hpp"
#include "tests/support/point_density.hpp"
#include "tests/support/rigid_fit.hpp"

namespace madori::bench {
namespace {

using namespace madori::localization;
using Pose = Transform2<Map, Base>;

struct Look {
  Stamp stamp{};
  ScanPoints points;
  Pose reference;
};

/// A log thinned to 0.5 Hz twice: what goes into the map, and what is sought in it.
struct Halves {
  std::vector<Look> mapped, sought;
};

/// Poses are asked for in the order of their stamps, at scans that the reference holds.
const app::StampedPose* pose_at(const std::vector<app::StampedPose>& poses, Stamp stamp) {
  constexpr double kSameS = 0.02;
  const auto at = std::lower_bound(poses.begin(), poses.end(), stamp - duration_from_seconds(kSameS),
                                   [](const auto& p, Stamp s) { return p.stamp < s; });
  return at != poses.end() && at->stamp <= stamp + duration_from_seconds(kSameS) ? &*at : nullptr;
}

Halves through(Mapper& mapper, const std::filesystem::path& folder, const std::string& name) {
  constexpr double kPeriodS = 0.975;  // of both, by turns
  auto reference = app::load_tum(folder / name / "reference.tum");
  std::stable_sort(reference.begin(), reference.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  sensors::carmen::CarmenReader log(folder / name / (name + ".log"));
  Halves halves;
  Stamp last = Stamp::min();
  bool to_map = false;
  while (auto record = log.next()) {
    if (const auto* odometry = std::get_if<OdometryReading>(&*record)) (void)mapper.on_odometry(*odometry);
    const auto* scan = std::get_if<sensors::ScanRecord>(&*record);
    if (scan == nullptr) continue;
    const Stamp stamp = scan->scan.stamp;
    if (scan->odom_from_base) (void)mapper.on_odometry({stamp, *scan->odom_from_base});
    if (last != Stamp::min() && to_seconds(stamp - last) < kPeriodS) continue;
    const auto* right = pose_at(reference, stamp);
    if (right == nullptr) continue;
    last = stamp;
    to_map = !to_map;
    Look look{stamp, scan_points(scan->scan, {}), right->map_from_base};
    if (to_map) (void)mapper.on_scan(stamp, look.points, {});
    (to_map ? halves.mapped : halves.sought).push_back(std::move(look));
  }
  return halves;
}

/// The map that the finished drive is: its scans where the mapper has them at last.
struct Built {
  std::vector<Look> scans;  ///< those in the map, `placed[i]` is where
  std::vector<Pose> placed;
  Transform2<Map, Map> reference_from_map;
  GrowingMap map;
  double noise_m = 0.0;
};

Built built(const FinishedMap& finished, const std::vector<Look>& mapped) {
  Built built;
  std::vector<Pose> references;
  for (const MomentPose& pose : finished.scans) {
    const auto at =
        std::find_if(mapped.begin(), mapped.end(), [&](const Look& l) { return l.stamp == pose.stamp; });
    if (at == mapped.end()) continue;
    built.scans.push_back(*at);
    built.placed.push_back(pose.map_from_base);
    references.push_back(at->reference);
    built.map.add(at->points, pose.map_from_base, {}, scan_noise_m(at->points));
  }
  built.reference_from_map = test::laid_on(built.placed, references);
  return built;
}

/// Where the map has a place: by the nearest of its scans.
Pose by_map(const Built& built, const Pose& reference) {
  std::size_t nearest = 0;
  const auto off = [&](std::size_t i) {
    return distance_m(built.scans[i].reference.translation(), reference.translation());
  };
  for (std::size_t i = 1; i < built.scans.size(); ++i)
    if (off(i) < off(nearest)) nearest = i;
  return built.placed[nearest] * (built.scans[nearest].reference.inverse() * reference);
}

void seek(const Built& built, const std::vector<Look>& sought, double grid_m, std::size_t every) {
  constexpr double kRightM = 0.3;
  StrategyOptions at;
  at.grid_m = grid_m;
  const GlobalViews views(built.map.points(), at);
  int tried = 0, answered = 0, by_reference = 0, in_map = 0;
  double e_psr = 0.0;
  const std::clock_t before = std::clock();
  for (std::size_t i = 0; i < sought.size(); i += every) {
    const Look& look = sought[i];
    ++tried;
    const auto found = localize_absolutely(look.points, built.map.points(), views, at);
    if (!found) continue;
    ++answered;
    const Pose& pose = found->fit.map_from_base;
    by_reference +=
        distance_m((built.reference_from_map * pose).translation(), look.reference.translation()) < kRightM;
    in_map += distance_m(pose.translation(), by_map(built, look.reference).translation()) < kRightM;
    e_psr += found->fit.e_psr_m;
  }
  const auto n = static_cast<double>(tried);
  std::printf("| %.1f | %zu | %d | %.1f %% | %.1f %% | %.1f %% | %.3f | %.0f |\n", grid_m, views.size(),
              tried, 100.0 * answered / n, 100.0 * by_reference / n, 100.0 * in_map / n,
              e_psr / std::max(answered, 1),
              1e3 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC / n);
  std::fflush(stdout);
}

void run(const std::filesystem::path& folder, const std::string& name, const std::string& method,
         const std::vector<double>& grids, std::size_t every) {
  const auto mapper = method == "graph" ? std::unique_ptr<Mapper>(std::make_unique<GraphMapper>())
                                        : std::make_unique<SlowLidarMapper>();
  const Halves halves = through(*mapper, folder, name);
  const Built map = built(mapper->finish(), halves.mapped);
  double off = 0.0, most = 0.0;
  for (std::size_t i = 0; i < map.scans.size(); ++i) {
    const double d = distance_m((map.reference_from_map * map.placed[i]).translation(),
                                map.scans[i].reference.translation());
    off += d / static_cast<double>(map.scans.size());
    most = std::max(most, d);
  }
  std::printf(
      "\n%s by %s: %zu of %zu scans in the map, %.3f m from the reference in the mean, %.3f at most, %.0f "
      "points/m2\n\n"
      "| g m | candidates | sought | answered | right by the reference | right in the map | e_psr m | ms |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- |\n",
      name.c_str(), method.c_str(), map.scans.size(), halves.mapped.size(), off, most,
      test::points_per_m2(map.map.points()));
  std::fflush(stdout);
  for (const double g : grids) seek(map, halves.sought, g, every);
}

}  // namespace
}  // namespace madori::bench

int main(int argc, char** argv) {
  if (argc < 2) return 1;
  const std::string logs = argc > 2 ? argv[2] : "intel,aces,fr079";
  std::vector<double> grids{0.2, 0.5, 0.8};
  if (argc > 4) grids = {std::atof(argv[4])};
  const std::size_t every = argc > 5 ? static_cast<std::size_t>(std::max(1, std::atoi(argv[5]))) : 1;
  for (const char* name : {"intel", "aces", "fr079"})
    if (logs.find(name) != std::string::npos)
      madori::bench::run(argv[1], name, argc > 3 ? argv[3] : "graph", grids, every);
}
