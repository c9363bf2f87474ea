#include "tests/bench/robustness/cases.hpp"

#include <cmath>

namespace madori::bench {
std::vector<Case> log_harms() {
  return {{.name = "start ++", .start_x_m = 0.35, .start_y_m = 0.35, .start_deg = 10.0},
          {.name = "start --", .start_x_m = -0.35, .start_y_m = -0.35, .start_deg = 10.0},
          {.name = "start +-", .start_x_m = 0.35, .start_y_m = -0.35, .start_deg = -10.0},
          {.name = "start -+", .start_x_m = -0.35, .start_y_m = 0.35, .start_deg = -10.0},
          {.name = "from 25 %", .log = {.begin = 0.25}},
          {.name = "from 50 %", .log = {.begin = 0.5}},
          {.name = "from 75 %", .log = {.begin = 0.75}},
          {.name = "backwards", .log = {.reversed = true}},
          {.name = "every 2nd scan", .log = {.every = 2}},
          {.name = "every 4th scan", .log = {.every = 4}},
          {.name = "wheels 5 % long", .log = {.distance_scale = 1.05}},
          {.name = "wheels 5 % short", .log = {.distance_scale = 0.95}},
          {.name = "turns 10 % more", .log = {.turn_scale = 1.1}},
          {.name = "bias 3 deg/m", .log = {.bias_rad_per_m = 0.052}},
          {.name = "noisy wheels", .log = {.noise = 0.15}},
          {.name = "laps", .laps = 10}};
}

std::vector<Case> ten_starts() {
  std::vector<Case> cases;
  for (int k = 0; k < 10; ++k) {
    const double a = 2.0 * kPi * k / 10.0;
    cases.push_back({.name = "ten " + std::to_string(k),
                     .start_x_m = 0.5 * std::cos(a),
                     .start_y_m = 0.5 * std::sin(a),
                     .start_deg = k % 2 == 0 ? -10.0 : 10.0});
  }
  return cases;
}

std::vector<Case> drawing_harms() {
  std::vector<Case> cases;
  for (const double s : {0.98, 0.99, 0.995, 1.005, 1.01, 1.02}) {
    cases.push_back({.name = "scale " + std::to_string(s).substr(0, 5), .lies = {.scale = s}});
  }
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const std::string n = " " + std::to_string(seed);
    cases.push_back({.name = "20 % missing" + n, .lies = {.missing = 0.2}, .seed = seed});
    cases.push_back({.name = "shift 0.15" + n, .lies = {.shift_m = 0.15}, .seed = seed});
    cases.push_back({.name = "bend 0.4" + n, .lies = {.bend_m = 0.4}, .seed = seed});
  }
  return cases;
}

std::vector<Case> rough_drawings() {
  std::vector<Case> cases;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    cases.push_back({.name = "rough " + std::to_string(seed),
                     .lies = {.bend_m = 0.3, .shift_m = 0.12, .missing = 0.15, .shortest_m = 1.2},
                     .seed = seed});
    cases.push_back({.name = "poor " + std::to_string(seed),
                     .lies = {.bend_m = 0.5, .shift_m = 0.2, .missing = 0.3, .shortest_m = 2.0},
                     .seed = seed});
  }
  return cases;
}

}  // namespace madori::bench
