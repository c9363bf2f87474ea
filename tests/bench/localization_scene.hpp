#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "localization/particle_filter/particles.hpp"
#include "localization/scan_points.hpp"
#include "tests/support/made_up_buildings.hpp"

namespace madori::bench {

using Pose = Transform2<Map, Base>;

/// The factory floor of the tests stretched to 100 m x 60 m.
inline mapping::Walls hall_100_by_60() {
  mapping::Walls walls = test::factory_floor();
  for (mapping::Wall& wall : walls)
    for (Point2<Map>* p : {&wall.segment.a, &wall.segment.b}) *p = {1.25 * p->x_m, 1.2 * p->y_m};
  return walls;
}

/// On the floor, not inside a machine or the offices.
template <class Engine>
Pose pose_on_the_floor(const mapping::Walls& walls, const mapping::DistanceField& field, Engine& engine) {
  for (;;) {
    const Pose pose = test::random_pose(walls, field, 0.5, 27.0, engine);
    if (pose.x_m() < 77.0 || pose.y_m() < 45.0) return pose;
  }
}

/// 540 beams over 270 degrees, a fifth of them on clutter, 1 cm of noise.
template <class Engine>
localization::ScanPoints scan_540(const mapping::Walls& walls, const Pose& pose, Engine& engine,
                                  double clutter = 0.2) {
  test::ScanSettings settings;
  settings.range_max_m = 60.0;
  settings.range_sigma_m = 0.01;
  settings.clutter = clutter;
  return localization::scan_points(test::simulate_scan(walls, pose, settings, engine), {});
}

/// 0.3 m and 5 degrees off in a random direction.
template <class Engine>
Pose start_off(const Pose& truth, Engine& engine) {
  std::uniform_real_distribution<double> direction(-kPi, kPi);
  const double a = direction(engine);
  const double turn = direction(engine) < 0.0 ? -5.0 : 5.0;
  return {truth.x_m() + 0.3 * std::cos(a), truth.y_m() + 0.3 * std::sin(a), truth.yaw_rad() + to_rad(turn)};
}

/// One registration task of the comparison.
struct Task {
  Pose truth;
  Pose start;
  localization::ScanPoints scan;
};

inline std::vector<Task> forty_tasks(const mapping::Walls& walls) {
  std::mt19937 engine(40);
  const mapping::DistanceField field(walls);
  std::vector<Task> tasks;
  for (int i = 0; i < 40; ++i) {
    const Pose truth = pose_on_the_floor(walls, field, engine);
    tasks.push_back({truth, start_off(truth, engine), scan_540(walls, truth, engine)});
  }
  return tasks;
}

/// Median and "right" (within 5 cm and 0.5 degrees) of the forty answers.
struct Accuracy {
  double median_m = 0.0;
  int right = 0;
};
inline Accuracy accuracy(const std::vector<Task>& tasks, const std::vector<Pose>& answers) {
  std::vector<double> errors;
  Accuracy result;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    errors.push_back(distance_m(tasks[i].truth.translation(), answers[i].translation()));
    const double turned = std::abs(wrap_angle(tasks[i].truth.yaw_rad() - answers[i].yaw_rad()));
    result.right += errors.back() < 0.05 && turned < to_rad(0.5);
  }
  std::sort(errors.begin(), errors.end());
  result.median_m = 0.5 * (errors[errors.size() / 2] + errors[(errors.size() - 1) / 2]);
  return result;
}

}  // namespace madori::bench
