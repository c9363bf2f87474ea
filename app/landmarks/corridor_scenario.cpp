#include "app/landmarks/corridor_scenario.hpp"

#include "core/angle.hpp"
#include "mapping/site/strict_yaml.hpp"

namespace madori::app {
namespace {

WheelNoise read_noise(mapping::StrictYaml yaml) {
  WheelNoise noise;
  noise.distance_m_per_root_m = yaml.number("distance_m_per_root_m", 0.0, 1.0);
  noise.heading_rad_per_root_m = to_rad(yaml.number("heading_deg_per_root_m", 0.0, 90.0));
  noise.turn_rad_per_root_turn = to_rad(yaml.number("turn_deg_per_root_turn", 0.0, 90.0));
  yaml.refuse_unknown_keys();
  return noise;
}

void read_odometry(mapping::StrictYaml yaml, CorridorScenario& scenario) {
  mapping::StrictYaml systematic = yaml.section("systematic");
  scenario.distance_error = systematic.number("distance", -0.5, 0.5);
  scenario.turn_error = systematic.number("turn", -0.5, 0.5);
  scenario.heading_error_rad_per_m = to_rad(systematic.number("heading_deg_per_m", -45.0, 45.0));
  systematic.refuse_unknown_keys();
  scenario.random = read_noise(yaml.section("random"));
  scenario.believed = read_noise(yaml.section("believed"));
  yaml.refuse_unknown_keys();
}

}  // namespace

CorridorScenario load_corridor_scenario(const std::filesystem::path& file) {
  CorridorScenario scenario;
  mapping::StrictYaml yaml = mapping::StrictYaml::load(file);
  mapping::StrictYaml corridor = yaml.section("corridor");
  scenario.outside_m = corridor.number("outside_m", 0.5, 1000.0);
  scenario.width_m = corridor.number("width_m", 0.1, 0.49 * scenario.outside_m);
  corridor.refuse_unknown_keys();
  scenario.laps = yaml.integer("laps", 1, 100);
  mapping::StrictYaml lidar = yaml.section("lidar");
  scenario.beams = lidar.integer("beams", 30, 4000);
  scenario.range_sigma_m = lidar.number("range_sigma_m", 0.0, 1.0);
  scenario.least_incidence_rad = to_rad(lidar.number_or("least_incidence_deg", 0.0, 0.0, 80.0));
  lidar.refuse_unknown_keys();
  mapping::StrictYaml driving = yaml.section("driving");
  scenario.corner_sigma_m = driving.number("corner_sigma_m", 0.0, 0.2 * scenario.width_m);
  driving.refuse_unknown_keys();
  read_odometry(yaml.section("odometry"), scenario);
  scenario.return_at_sigma_m = yaml.number_or("return_at_sigma_m", 0.0, 0.0, 100.0);
  yaml.refuse_unknown_keys();
  return scenario;
}

}  // namespace madori::app
