// Table 1 of Kis, Csemesz, Csáji (2021): a hall of 200 m², 270 degrees in steps of half a degree, 0.5 Hz,
// 0.3 m/s, about 85 scans, Gaussian noise on x and y of every point; ten runs a level, then ten absolute
// localizations a run on the map that it built. e_psr is to the points of that map. A place is right within
// 0.2 m and 2 degrees: in the map, of where the map has it (its nearest scan, and the true motion from
// there), which is what the published success is about; by truth, after the map was laid rigidly on the
// truth. `bench_slow_lidar [runs [first seed [sigma]]]`
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>

#include "localization/slam/slow_lidar_mapper.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/made_up_drive.hpp"
#include "tests/support/point_density.hpp"
#include "tests/support/rigid_fit.hpp"

namespace madori::bench {
namespace {

using namespace madori::localization;
using Pose = Transform2<Map, Base>;

/// Around the machines and back, about 50 m.
const std::vector<Point2<Map>> kWay{{2.5, 1.2},  {11.0, 1.2}, {14.4, 1.0}, {14.4, 4.2}, {14.4, 8.2},
                                    {19.0, 8.4}, {19.2, 4.4}, {14.4, 4.2}, {10.8, 4.0}, {10.6, 7.6},
                                    {7.0, 7.8},  {6.5, 5.0},  {2.6, 5.0},  {6.4, 4.6},  {6.5, 1.2}};

struct Series {
  std::vector<double> values;
  void add(double v) { values.push_back(v); }
  [[nodiscard]] double mean() const {
    return values.empty()
               ? 0.0
               : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  }
  [[nodiscard]] double deviation() const {
    double sum = 0.0;
    for (const double v : values) sum += (v - mean()) * (v - mean());
    return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
  }
};

struct Level {
  Series relative, causal_truth, final_truth, absolute, absolute_map, absolute_truth, density;
  int scans = 0, lost = 0, tried = 0, right_in_map = 0, right = 0;
};

Pose seen_from(const Pose& start, const Pose& pose) {
  const auto relative = start.inverse() * pose;
  return {relative.x_m(), relative.y_m(), relative.yaw_rad()};
}

bool same(const Pose& a, const Pose& b) {
  return distance_m(a.translation(), b.translation()) < 0.2 &&
         std::abs(wrap_angle(a.yaw_rad() - b.yaw_rad())) < to_rad(2.0);
}

/// Where the mapper has a place: by the nearest of its scans and the true motion from there.
Pose by_map(const Pose& place, const std::vector<Pose>& mapped, const std::vector<Pose>& truth) {
  const auto off = [&](const Pose& p) { return distance_m(p.translation(), place.translation()); };
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < truth.size(); ++i)
    if (off(truth[i]) < off(truth[nearest])) nearest = i;
  return mapped[nearest] * (truth[nearest].inverse() * place);
}

/// The map that was built, and the truth from where the drive began.
struct Built {
  const SlowLidarMapper& mapper;
  Pose start;
  std::vector<Pose> mapped, truth;
};

void locate_absolutely(const mapping::Walls& walls, const Built& built, double sigma_m, std::mt19937& engine,
                       Level& level) {
  const mapping::DistanceField field(walls);
  const PointMap& map = built.mapper.map().points();
  const GlobalViews views(map, built.mapper.strategies_for({}));
  const Transform2<Map, Map> truth_from_map = test::laid_on(built.mapped, built.truth);
  for (int i = 0; i < 10; ++i) {
    const Pose place = test::random_pose(walls, field, 0.5, 4.0, engine);
    const ScanPoints scan =
        test::noisy_points(test::simulate_scan(walls, place, {}, engine), sigma_m, engine);
    const auto found = localize_absolutely(scan, map, views, built.mapper.strategies_for(scan));
    const Pose right = seen_from(built.start, place);
    const Pose expected = by_map(right, built.mapped, built.truth);
    ++level.tried;
    if (!found) continue;
    const Pose& pose = found->fit.map_from_base;
    level.right += same(truth_from_map * pose, right);
    if (!same(pose, expected)) continue;
    ++level.right_in_map;
    level.absolute.add(found->fit.e_psr_m);
    level.absolute_map.add(distance_m(pose.translation(), expected.translation()));
    level.absolute_truth.add(distance_m((truth_from_map * pose).translation(), right.translation()));
  }
}

void add_errors(const std::vector<Pose>& poses, const std::vector<Pose>& truth, Series& errors) {
  const Transform2<Map, Map> by = test::laid_on(poses, truth);
  for (std::size_t i = 0; i < truth.size(); ++i)
    errors.add(distance_m((by * poses[i]).translation(), truth[i].translation()));
}

void run(double sigma_m, unsigned seed, Level& level) {
  std::mt19937 engine(seed);
  const mapping::Walls walls = test::laboratory_hall();
  const auto moments = test::drive(walls, kWay, test::half_hertz(), engine);
  SlowLidarMapper mapper;
  std::vector<Pose> causal, mapped, truth;  // of the scans in the map
  for (const auto& moment : moments) {
    (void)mapper.on_odometry(moment.odometry);
    if (!moment.has_scan) continue;
    const PoseEstimate pose =
        mapper.on_scan(moment.scan.stamp, test::noisy_points(moment.scan, sigma_m, engine), {});
    ++level.scans;
    level.lost += pose.health.state == LocalizationState::Lost;
    if (pose.health.state == LocalizationState::Lost) continue;
    causal.push_back(pose.map_from_base);
    truth.push_back(seen_from(moments.front().truth, moment.truth));
  }
  for (const double e : mapper.e_psr_m()) level.relative.add(e);
  for (const MomentPose& pose : mapper.finish().scans) mapped.push_back(pose.map_from_base);
  add_errors(causal, truth, level.causal_truth);
  add_errors(mapped, truth, level.final_truth);
  level.density.add(test::points_per_m2(mapper.map().points()));
  locate_absolutely(walls, {mapper, moments.front().truth, mapped, truth}, sigma_m, engine, level);
}

void print(double sigma_m, const Level& level) {
  std::printf(
      "| %.1f | %d | %d | %.3f (%.3f) | %.3f | %.3f | %.3f (%.3f) | %.3f | %.3f | %.1f %% | %.1f %% | %.0f "
      "|\n",
      sigma_m, level.scans, level.lost, level.relative.mean(), level.relative.deviation(),
      level.causal_truth.mean(), level.final_truth.mean(), level.absolute.mean(), level.absolute.deviation(),
      level.absolute_map.mean(), level.absolute_truth.mean(), 100.0 * level.right_in_map / level.tried,
      100.0 * level.right / level.tried, level.density.mean());
  std::fflush(stdout);
}

}  // namespace
}  // namespace madori::bench

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::atoi(argv[1]) : 10;
  const unsigned seed = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 200U;
  std::vector<double> sigmas{0.0, 0.1, 0.2, 0.3};
  if (argc > 3) sigmas = {std::atof(argv[3])};
  std::printf(
      "| sigma m | scans | lost | relative e_psr m | causal off truth m | final off truth m | absolute e_psr "
      "m | "
      "off the map m | off truth m | right in the map | right by truth | points/m2 |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const double sigma : sigmas) {
    madori::bench::Level level;
    for (int i = 0; i < runs; ++i) madori::bench::run(sigma, seed + static_cast<unsigned>(i), level);
    madori::bench::print(sigma, level);
  }
}
