// Table 1 of Kis, Csemesz, Csáji (2021): a hall of 200 m², 270 degrees in steps of half a degree, 0.5 Hz,
// 0.3 m/s, about 85 scans, Gaussian noise on x and y of every point; ten runs a level, then ten absolute
// localizations a run on the map that it built. e_psr is to the points of that map. `bench_slow_lidar [runs]`
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>

#include "localization/registration/point_icp.hpp"
#include "localization/slam/slow_lidar_mapper.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/made_up_drive.hpp"

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
  Series relative, as_started, relative_truth, absolute, absolute_truth, density;
  int scans = 0, lost = 0, tried = 0, right = 0;
};

ScanPoints noisy(const LaserScan& scan, double sigma_m, std::mt19937& engine) {
  std::normal_distribution<float> noise(0.0F, 1.0F);
  ScanPoints points = scan_points(scan, {});
  for (auto* array : {&points.x_m, &points.y_m})
    for (float& v : *array) v += static_cast<float>(sigma_m) * noise(engine);
  return points;
}

Pose seen_from(const Pose& start, const Pose& pose) {
  const auto relative = start.inverse() * pose;
  return {relative.x_m(), relative.y_m(), relative.yaw_rad()};
}

bool same(const Pose& a, const Pose& b) {
  return distance_m(a.translation(), b.translation()) < 0.2 &&
         std::abs(wrap_angle(a.yaw_rad() - b.yaw_rad())) < to_rad(2.0);
}

/// What lays the poses that were answered on the true ones: a map has no place of its own, and noise in its
/// first scans turns all of it.
Transform2<Map, Map> laid_on_truth(const std::vector<Pose>& answered, const std::vector<Pose>& truth) {
  const auto n = static_cast<double>(answered.size());
  double ax = 0.0, ay = 0.0, bx = 0.0, by = 0.0, dot = 0.0, cross = 0.0;
  for (std::size_t i = 0; i < answered.size(); ++i) {
    ax += answered[i].x_m() / n, ay += answered[i].y_m() / n;
    bx += truth[i].x_m() / n, by += truth[i].y_m() / n;
  }
  for (std::size_t i = 0; i < answered.size(); ++i) {
    const double px = answered[i].x_m() - ax, py = answered[i].y_m() - ay;
    const double qx = truth[i].x_m() - bx, qy = truth[i].y_m() - by;
    dot += px * qx + py * qy;
    cross += px * qy - py * qx;
  }
  const Transform2<Map, Map> turn(0.0, 0.0, std::atan2(cross, dot));
  const Point2<Map> turned = turn * Point2<Map>{ax, ay};
  return {bx - turned.x_m, by - turned.y_m, turn.yaw_rad()};
}

void locate_absolutely(const mapping::Walls& walls, const mapping::DistanceField& field, const Pose& start,
                       const Transform2<Map, Map>& truth_from_map, const SlowLidarMapper& mapper,
                       double sigma_m, std::mt19937& engine, Level& level) {
  for (int i = 0; i < 10; ++i) {
    const Pose truth = test::random_pose(walls, field, 0.5, 4.0, engine);
    const ScanPoints scan = noisy(test::simulate_scan(walls, truth, {}, engine), sigma_m, engine);
    const auto found = localize_absolutely(scan, mapper.map().points(), mapper.strategies_for(scan));
    const Pose right = seen_from(start, truth);
    ++level.tried;
    if (!found || !same(truth_from_map * found->fit.map_from_base, right)) continue;
    ++level.right;
    level.absolute.add(found->fit.e_psr_m);
    level.absolute_truth.add(
        distance_m((truth_from_map * found->fit.map_from_base).translation(), right.translation()));
  }
}

void run(double sigma_m, unsigned seed, Level& level) {
  std::mt19937 engine(seed);
  const mapping::Walls walls = test::laboratory_hall();
  const mapping::DistanceField field(walls);
  test::DriveSettings settings;
  settings.steps_per_scan = 6;  // 0.6 m: 0.3 m/s at 0.5 Hz
  settings.sigma_rad_per_m = 0.03;
  settings.sigma_distance = 0.03;
  settings.lidar = test::ScanSettings{};
  const auto moments = test::drive(walls, kWay, settings, engine);
  SlowLidarMapper mapper;
  std::vector<Pose> answered, truth;
  for (const auto& moment : moments) {
    (void)mapper.on_odometry(moment.odometry);
    if (!moment.has_scan) continue;
    const ScanPoints points = noisy(moment.scan, sigma_m, engine);
    const PoseEstimate pose = mapper.on_scan(moment.scan.stamp, points, {});
    ++level.scans;
    level.lost += pose.health.state == LocalizationState::Lost;
    const Pose right = seen_from(moments.front().truth, moment.truth);
    answered.push_back(pose.map_from_base);
    truth.push_back(right);
  }
  const Transform2<Map, Map> by = laid_on_truth(answered, truth);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    level.as_started.add(distance_m(answered[i].translation(), truth[i].translation()));
    level.relative_truth.add(distance_m((by * answered[i]).translation(), truth[i].translation()));
  }
  for (const double e : mapper.e_psr_m()) level.relative.add(e);
  level.density.add(mapper.map().density_per_m2());
  locate_absolutely(walls, field, moments.front().truth, by, mapper, sigma_m, engine, level);
}

}  // namespace
}  // namespace madori::bench

int main(int argc, char** argv) {
  using madori::bench::Level;
  const int runs = argc > 1 ? std::atoi(argv[1]) : 10;
  std::printf(
      "| sigma m | scans | lost | relative e_psr m | off truth m | with the map laid on it m | absolute "
      "e_psr m | off truth m | "
      "success | points/m2 |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const double sigma : {0.0, 0.1, 0.2, 0.3}) {
    Level level;
    for (int i = 0; i < runs; ++i) madori::bench::run(sigma, 100U + static_cast<unsigned>(i), level);
    std::printf("| %.1f | %d | %d | %.3f (%.3f) | %.3f | %.3f | %.3f (%.3f) | %.3f | %.1f %% | %.0f |\n",
                sigma, level.scans, level.lost, level.relative.mean(), level.relative.deviation(),
                level.as_started.mean(), level.relative_truth.mean(), level.absolute.mean(),
                level.absolute.deviation(), level.absolute_truth.mean(), 100.0 * level.right / level.tried,
                level.density.mean());
    std::fflush(stdout);
  }
}
