#include "tests/support/mounting_trial.hpp"

#include <chrono>
#include <memory>
#include <random>

#include "app/cycle/site_config.hpp"
#include "app/lidars.hpp"
#include "app/mounting/mounting_log.hpp"
#include "app/mounting/mounting_manoeuvre.hpp"
#include "core/angle.hpp"
#include "tests/support/factory_link.hpp"

namespace madori::test {
namespace {

using Random = std::mt19937_64;

double between(Random& random, double low, double high) {
  return std::uniform_real_distribution(low, high)(random);
}

/// A hall of 12 to 25 m with things along its walls; the vehicle stands somewhere in the middle.
simulation::FactorySetup hall(const MountingTrial& trial) {
  Random random(trial.seed);
  simulation::FactorySetup setup;
  double length = between(random, 12.0, 25.0), width = between(random, 9.0, 16.0);
  if (trial.corridor) length = 60.0, width = 3.2;
  const Point2<Map> a{0.0, 0.0}, b{length, 0.0}, c{length, width}, d{0.0, width};
  setup.walls = {{1, {a, b}}, {2, {b, c}}, {3, {c, d}}, {4, {d, a}}};
  auto& s = setup.scenario;
  s.name = "mounting";
  s.start = {length / 2.0 + between(random, -1.5, 1.5), width / 2.0 + between(random, -1.0, 1.0),
             between(random, -kPi, kPi)};
  if (trial.corridor) s.start = {length / 2.0, width / 2.0, 0.1};
  for (int i = 0; i < 8 && !trial.corridor; ++i) {
    simulation::SolidSpec solid;
    solid.kind = i % 2 == 0 ? simulation::SolidKind::Machine : simulation::SolidKind::Pallet;
    solid.name = "thing " + std::to_string(i);
    const bool along = i % 4 < 2;
    solid.centre = {along ? between(random, 1.0, length - 1.0) : (i % 8 < 4 ? 1.0 : length - 1.0),
                    along ? (i % 8 < 4 ? 1.0 : width - 1.0) : between(random, 1.0, width - 1.0)};
    solid.yaw_deg = between(random, -20.0, 20.0);
    solid.length_m = between(random, 0.6, 1.8);
    solid.width_m = between(random, 0.5, 1.2);
    solid.height_m = between(random, 0.3, 1.8);
    s.solids.push_back(solid);
  }
  simulation::MoverSpec person;
  person.name = "person";
  person.path = {{1.5, 2.2}, {length - 1.5, 2.2}};
  s.movers.push_back(person);
  s.vehicle.left_radius_error_percent = between(random, -0.7, 0.7);
  s.vehicle.right_radius_error_percent = between(random, -0.7, 0.7);
  s.vehicle.separation_error_percent = between(random, -1.5, 1.5);
  s.vehicle.slip_percent = between(random, 0.0, 1.0);
  s.vehicle.slip_noise = 0.001;
  setup.seed = s.seed = trial.seed;
  setup.sensors = trial.truth;
  return setup;
}

}  // namespace

MountingTrialResult run_mounting_trial(const MountingTrial& trial) {
  constexpr Duration kStep = std::chrono::milliseconds(20);
  constexpr double kMostS = 90.0;
  const auto setup = hall(trial);
  const auto factory = std::make_shared<simulation::Factory>(setup);
  std::vector<LidarModel> lidars;
  for (const auto& sensor : trial.typed) lidars.push_back(app::lidar_model(sensor));
  const auto config = app::vehicle_config(setup.vehicle, lidars);
  FactoryLink link(factory, config.odometry.wheels, kStep);
  app::MountingLog log(config.odometry.wheels);
  app::MountingManoeuvre drive(config, {.way_m = trial.way_m, .turn_rad = trial.turn_rad});
  using Stage = app::MountingManoeuvre::Stage;
  for (double t = 0.0; t < kMostS && drive.stage() != Stage::Done && drive.stage() != Stage::Stopped;
       t += 0.02) {
    app::CycleInput input;
    link.collect(input);
    if (t >= trial.pressed_at_s && t < trial.pressed_at_s + 0.3)
      for (auto& status : input.drive) status.emergency_stop = true;
    input.now = factory->now();
    log.add(input);
    link.send(drive.step(input, log.odometry()));
  }
  MountingTrialResult result;
  result.driven = drive.stage() == Stage::Done;
  result.stopped = drive.notice().text;
  result.contacts = factory->collisions().size();
  const auto begun = std::chrono::steady_clock::now();
  auto driven = log.drive();
  if (trial.wired_wrongly) trial.wired_wrongly(driven);
  result.found = localization::calibrate_mounting(driven, lidars, config.odometry.wheels);
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return result;
}

MountingTrial random_mounting(const std::string& type, std::uint64_t seed) {
  Random random(seed * 7919 + 13);
  MountingTrial trial;
  trial.seed = seed;
  mapping::SensorRecord truth{"lidar",
                              type,
                              between(random, -0.15, 0.75),
                              between(random, -0.28, 0.28),
                              between(random, 0.15, 0.4),
                              between(random, -180.0, 180.0)};
  if (type == "vlp16") truth.z_m = between(random, 0.9, 1.6);
  auto typed = truth;
  typed.x_m += between(random, -0.2, 0.2);
  typed.y_m += between(random, -0.2, 0.2);
  typed.yaw_deg += between(random, -20.0, 20.0);
  trial.truth = {truth};
  trial.typed = {typed};
  return trial;
}

}  // namespace madori::test
