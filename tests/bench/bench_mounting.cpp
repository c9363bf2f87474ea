// How exactly the mounting of a lidar is found by a short drive: random mountings of each kind in virtual
// halls with noise, wheel slip and unequal wheels. Seeds from 1000 on are those that constants were chosen
// on.
//   bench_mounting [--seed FIRST] [--count N] [--kind TYPE]
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/angle.hpp"
#include "sensors/lidar/registry.hpp"
#include "tests/support/mounting_trial.hpp"

namespace {

struct Worst {
  double place_m = 0.0, yaw_rad = 0.0, height_m = 0.0;
  int good = 0, missed = 0, trials = 0;
  std::vector<double> place_sigmas;
};

void run_kind(const std::string& type, std::uint64_t first, int count) {
  using namespace madori;
  Worst worst;
  for (int i = 0; i < count; ++i) {
    const auto trial = test::random_mounting(type, first + static_cast<std::uint64_t>(i));
    const auto result = test::run_mounting_trial(trial);
    const auto& truth = trial.truth.front();
    const auto& found = result.found.lidars.front();
    const double dx = found.mounting.x_m - truth.x_m, dy = found.mounting.y_m - truth.y_m;
    const double yaw = wrap_angle(found.mounting.yaw_rad - to_rad(truth.yaw_deg));
    const bool all = found.known == localization::MountingKnown::All;
    ++worst.trials;
    worst.missed += all ? 0 : 1;
    worst.good += all && std::hypot(dx, dy) <= 0.01 && std::abs(yaw) <= to_rad(0.3) ? 1 : 0;
    if (all) {
      worst.place_m = std::max(worst.place_m, std::hypot(dx, dy));
      worst.yaw_rad = std::max(worst.yaw_rad, std::abs(yaw));
      if (found.floor) worst.height_m = std::max(worst.height_m, std::abs(found.mounting.z_m - truth.z_m));
    }
    std::printf(
        "%-7s %4llu  x %+5.2f y %+5.2f yaw %+6.1f  off %+6.1f %+6.1f mm %+6.3f deg  sigma %4.1f %4.1f mm "
        "%5.3f "
        "deg  residual %4.1f mm  height %+6.1f mm  %d sweeps %d walls  %.1f s%s%s\n",
        type.c_str(), static_cast<unsigned long long>(trial.seed), truth.x_m, truth.y_m, truth.yaw_deg,
        dx * 1e3, dy * 1e3, to_deg(yaw), found.sigma[0] * 1e3, found.sigma[1] * 1e3, to_deg(found.sigma[2]),
        found.residual_m * 1e3, found.floor ? (found.mounting.z_m - truth.z_m) * 1e3 : 0.0, found.sweeps,
        found.walls, result.wall_s, all ? "" : "  NOT FOUND",
        result.driven ? "" : ("  NOT DRIVEN " + result.stopped).c_str());
    std::fflush(stdout);
  }
  std::printf(
      "%-7s within 1 cm and 0.3 deg: %d of %d (not found %d); worst %.1f mm, %.3f deg, height %.1f mm\n",
      type.c_str(), worst.good, worst.trials, worst.missed, worst.place_m * 1e3, to_deg(worst.yaw_rad),
      worst.height_m * 1e3);
}

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t first = 1;
  int count = 20;
  std::string kind;
  CLI::App app;
  app.add_option("--seed", first);
  app.add_option("--count", count);
  app.add_option("--kind", kind);
  CLI11_PARSE(app, argc, argv);
  for (const auto& row : madori::sensors::lidar_rows())
    if (kind.empty() || kind == row.type) run_kind(row.type, first, count);
}
