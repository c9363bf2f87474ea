#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/laser_scan.hpp"
#include "core/odometry.hpp"
#include "localization/scan_points.hpp"
#include "tests/support/ray_caster.hpp"

namespace madori::test {

/// Truth, wheels and lidar of one moment of a made-up drive.
struct DriveMoment {
  Transform2<Map, Base> truth;
  OdometryReading odometry;
  bool has_scan = false;
  LaserScan scan;
};

/// How the made-up vehicle drives and errs.
struct DriveSettings {
  double step_m = 0.1;
  double step_rad = 0.1;
  int steps_per_scan = 3;
  double bias_rad_per_m = 0.0;    ///< systematic: the wheels report too much left turn
  double bias_distance = 0.0;     ///< systematic: share of the distance reported too much
  double sigma_rad_per_m = 0.01;  ///< random
  double sigma_distance = 0.01;   ///< random, share
  ScanSettings lidar = full_turn(180, 30.0);
};

/// Ten scans a second all around, on wheels that err little.
inline DriveSettings ten_hertz(double range_max_m = 40.0) {
  DriveSettings settings;
  settings.steps_per_scan = 1;
  settings.sigma_rad_per_m = 0.002;
  settings.sigma_distance = 0.005;
  settings.lidar = full_turn(360, range_max_m);
  settings.lidar.range_sigma_m = 0.02;
  return settings;
}

/// 0.3 m/s at 0.5 Hz, so a scan of 270 degrees every 0.6 m, on wheels wrong by 3 %.
inline DriveSettings half_hertz() {
  DriveSettings settings;
  settings.steps_per_scan = 6;
  settings.sigma_rad_per_m = 0.03;
  settings.sigma_distance = 0.03;
  settings.lidar = ScanSettings{};
  return settings;
}

/// A scan's points with Gaussian noise on x and y, as Kis et al. have it.
template <class Engine>
localization::ScanPoints noisy_points(const LaserScan& scan, double sigma_m, Engine& engine) {
  std::normal_distribution<float> noise(0.0F, 1.0F);
  localization::ScanPoints points = localization::scan_points(scan, {});
  for (auto* array : {&points.x_m, &points.y_m})
    for (float& v : *array) v += static_cast<float>(sigma_m) * noise(engine);
  return points;
}

/// Drives from point to point: turns on the spot, then straight on.
template <class Engine>
std::vector<DriveMoment> drive(const mapping::Walls& walls, const std::vector<Point2<Map>>& stops,
                               const DriveSettings& settings, Engine& engine) {
  std::normal_distribution<double> noise;
  std::vector<DriveMoment> moments;
  Transform2<Odom, Base> odom;
  Transform2<Map, Base> truth(stops[0].x_m, stops[0].y_m,
                              std::atan2(stops[1].y_m - stops[0].y_m, stops[1].x_m - stops[0].x_m));
  const auto moment = [&](double distance, double turn) {
    truth = truth * Transform2<Base, Base>(distance, 0.0, turn);
    const double seen = distance * (1.0 + settings.bias_distance + settings.sigma_distance * noise(engine));
    const double seen_turn =
        turn + distance * (settings.bias_rad_per_m + settings.sigma_rad_per_m * noise(engine));
    odom = odom * Transform2<Base, Base>(seen, 0.0, seen_turn);
    DriveMoment m;
    m.truth = truth;
    m.odometry = {stamp_from_seconds(0.1 * static_cast<double>(moments.size())), odom};
    m.has_scan = moments.size() % static_cast<std::size_t>(settings.steps_per_scan) == 0;
    if (m.has_scan) {
      m.scan = simulate_scan(walls, truth, settings.lidar, engine);
      m.scan.stamp = m.odometry.stamp;
    }
    moments.push_back(std::move(m));
  };
  moment(0.0, 0.0);
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const double dx = stops[i].x_m - truth.x_m();
    const double dy = stops[i].y_m - truth.y_m();
    const double turn = wrap_angle(std::atan2(dy, dx) - truth.yaw_rad());
    const int turns = static_cast<int>(std::ceil(std::abs(turn) / settings.step_rad));
    for (int k = 0; k < turns; ++k) moment(0.0, turn / turns);
    const int steps = std::max(1, static_cast<int>(std::ceil(std::hypot(dx, dy) / settings.step_m)));
    for (int k = 0; k < steps; ++k) moment(std::hypot(dx, dy) / steps, 0.0);
  }
  return moments;
}

/// The same, with everything left to chance from a seed.
inline std::vector<DriveMoment> drive(const mapping::Walls& walls, const std::vector<Point2<Map>>& stops,
                                      const DriveSettings& settings, unsigned seed) {
  std::mt19937 engine(seed);
  return drive(walls, stops, settings, engine);
}

}  // namespace madori::test
