#include "tests/support/localization_trial.hpp"

#include <algorithm>
#include <string>

#include "planning/route_graph/route_csv.hpp"
#include "simulation/scenario/scenario.hpp"
#include "tests/support/cloud_in_base.hpp"
#include "tests/support/lidar_models.hpp"

namespace madori::test {
namespace {

WheelGeometry wheels() {
  const mapping::VehicleRecord vehicle;
  return {vehicle.wheel_radius_m, vehicle.wheel_radius_m, vehicle.half_wheel_separation_m};
}

}  // namespace

TrialSetup sample_factory_trial(const std::filesystem::path& data, double hidden_percent, int day,
                                double clutter_m) {
  TrialSetup setup;
  setup.scenario = simulation::load_scenario(data / "scenarios/sample_factory.yaml");
  setup.drawing = setup.walls = mapping::load_walls(data / "sample_factory/true_walls.csv");
  setup.routes = planning::load_routes(data / "sample_factory/routes_factory");
  auto& furniture = setup.scenario.furniture;
  furniture.day = day;
  furniture.hide_walls_percent = hidden_percent;
  furniture.clutter_height_m = clutter_m;
  if (hidden_percent == 0.0) {
    setup.scenario.movers.clear();
    furniture.count = 0;
    return setup;
  }
  for (auto& mover : setup.scenario.movers) mover.patience_s = std::max(mover.patience_s, 5.0);
  const auto& nodes = setup.routes.nodes();
  for (std::size_t i = 0; i < 12; ++i) {
    simulation::MoverSpec person;
    person.name = "person " + std::to_string(i);
    const Point2<Map>& at = nodes[(2 * i + static_cast<std::size_t>(day)) % nodes.size()].position;
    person.path = {{at.x_m + 1.1, at.y_m + 1.0}, {at.x_m + 1.1, at.y_m - 1.4}};
    person.pause_s = 2.0 + static_cast<double>(i % 4);
    person.patience_s = 5.0;  // else a person and the vehicle may wait for each other for ever
    setup.scenario.movers.push_back(person);
  }
  return setup;
}

void scale_drawing(TrialSetup& setup, double scale) {
  setup.drawing_scale *= scale;
  for (mapping::Wall& wall : setup.drawing)
    for (Point2<Map>* p : {&wall.segment.a, &wall.segment.b}) *p = {p->x_m * scale, p->y_m * scale};
}

void change_building(TrialSetup& setup) {
  auto& moved = setup.scenario.building.moved_walls;
  moved.push_back({{33, 34, 35, 36}, 0.3, -0.2});
  moved.push_back({{251, 252, 253}, 0.0, 0.3});
  moved.push_back({{213, 219}, 0.2, 0.0});
  setup.scenario.building.missing_walls = {29, 30, 31, 32};
  setup.scenario.building.added_walls.push_back({{14.0, 9.5}, {14.0, 12.0}});
}

LocalizationTrial::LocalizationTrial(const TrialSetup& setup, std::uint64_t seed,
                                     const localization::LocalizerOptions& options)
    : routes_(setup.routes),
      floor_(setup.walls, setup.scenario, seed),
      driver_(routes_, seed),
      odometry_(control::OdometryOptions{wheels()}),
      localizer_(setup.drawing, std::nullopt, options),
      drawing_scale_(setup.drawing_scale) {
  pose_.health = {LocalizationState::Lost, "no scan yet"};
}

void LocalizationTrial::step(bool drives) {
  const VelocityCommand command = drives ? driver_.command(floor_) : VelocityCommand{};
  const FloorInput input = floor_.step(command);
  for (const auto& status : input.drive) {
    // The newest frame has just come, the others were measured so much earlier.
    const auto age = std::chrono::microseconds(input.drive.back().time_us - status.time_us);
    odometry_.update(status, input.now - age);
    (void)track_.add(odometry_.reading());
    pose_ = localizer_.on_odometry(odometry_.reading());
  }
  for (const auto& cloud : input.clouds) {
    const mapping::SensorRecord& lidar = floor_.lidar();
    const LidarModel model = spinning_lidar({lidar.x_m, lidar.y_m, lidar.z_m, to_rad(lidar.yaw_deg)});
    const auto base = test::cloud_in_base(cloud, model, track_);
    const auto points = localization::extract_walls(base, model);
    const PoseEstimate at_scan = localizer_.on_scan(base.stamp, points, {lidar.x_m, lidar.y_m});
    if (learner != nullptr) learner->observe(points, {lidar.x_m, lidar.y_m}, at_scan);
    pose_ = localizer_.on_odometry(odometry_.reading());
  }
  watch();
}

bool LocalizationTrial::drive(double metres, double most_s) {
  const double end_m = floor_.driven_m() + metres;
  const double end_s = figures_.simulated_s + most_s;
  while (floor_.driven_m() < end_m && figures_.simulated_s < end_s) step();
  return floor_.driven_m() >= end_m;
}

void LocalizationTrial::kidnap(const Transform2<Map, Base>& to) {
  floor_.set_pose(to);
  driver_.forget();
}

double LocalizationTrial::error_m() const {
  const auto truth = floor_.truth_at(pose_.stamp);
  return distance_m(pose_.map_from_base.translation(),
                    Point2<Map>{drawing_scale_ * truth.x_m(), drawing_scale_ * truth.y_m()});
}

double LocalizationTrial::error_rad() const {
  return std::abs(wrap_angle(pose_.map_from_base.yaw_rad() - floor_.truth_at(pose_.stamp).yaw_rad()));
}

void LocalizationTrial::watch() {
  TrialFigures& f = figures_;
  f.driven_m = floor_.driven_m();
  f.simulated_s += kStep_s;
  const LocalizationState state = pose_.health.state;
  const bool knows = state == LocalizationState::Localized || state == LocalizationState::Degraded;
  if (f.first_fix_s < 0.0 && knows) f.first_fix_s = f.simulated_s;
  if (f.first_fix_s < 0.0) return;
  f.localized_s += state == LocalizationState::Localized ? kStep_s : 0.0;
  f.degraded_s += state == LocalizationState::Degraded ? kStep_s : 0.0;
  f.ambiguous_s += state == LocalizationState::Ambiguous ? kStep_s : 0.0;
  f.lost_s += state == LocalizationState::Lost ? kStep_s : 0.0;
  f.losses += state == LocalizationState::Lost && before_ != LocalizationState::Lost;
  before_ = state;
  if (!knows) return;
  f.samples += 1.0;
  f.square_m2 += error_m() * error_m();
  f.square_rad2 += error_rad() * error_rad();
  f.worst_m = std::max(f.worst_m, error_m());
  f.worst_rad = std::max(f.worst_rad, error_rad());
}

}  // namespace madori::test
