// Localization in the virtual factory, without sockets and without waiting: accuracy, kidnappings, health
// over a long way. What it measures stands in docs/reference/localization-figures.md with the commands.
// Build: cmake --build build/release --target bench_factory. Exit 1 where a vehicle was lost that should not
// be.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "tests/support/kidnappings.hpp"
#include "tests/support/localization_trial.hpp"

namespace madori {
namespace {

using Clock = std::chrono::steady_clock;
using Pose = Transform2<Map, Base>;

struct Arguments {
  std::string data = MADORI_DATA_DIR;
  int runs = 20;
  int first = 0;
  double metres = 500.0;
  double hidden_percent = 30.0;
  double clutter_m = 1.8;
  int count = 200;
  int kind = -1;
  unsigned seed = 1;
  double learn_metres = 300.0;
  double drawing_scale = 1.0;
  bool changed = false;
  bool verbose = false;
};

test::TrialSetup setup_of(const Arguments& a, int day) {
  auto setup = test::sample_factory_trial(a.data, a.hidden_percent, day, a.clutter_m);
  test::scale_drawing(setup, a.drawing_scale);
  if (a.changed) test::change_building(setup);
  return setup;
}

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

void print(const char* what, const test::TrialFigures& f, double wall_s) {
  std::printf(
      "%-10s %7.0f m  position RMSE %.4f m, most %.3f m  heading RMSE %.3f deg, most %.2f deg  lost %d "
      "times, "
      "%.2f s  DEGRADED %.3f %%  (%.0f x real time)\n",
      what, f.driven_m, f.rmse_m(), f.worst_m, to_deg(f.rmse_rad()), to_deg(f.worst_rad), f.losses, f.lost_s,
      100.0 * f.degraded_share(), f.simulated_s / wall_s);
  std::fflush(stdout);
}

void add(test::TrialFigures& all, const test::TrialFigures& f) {
  all.driven_m += f.driven_m, all.simulated_s += f.simulated_s;
  all.localized_s += f.localized_s, all.degraded_s += f.degraded_s;
  all.ambiguous_s += f.ambiguous_s, all.lost_s += f.lost_s, all.losses += f.losses;
  all.square_m2 += f.square_m2, all.square_rad2 += f.square_rad2, all.samples += f.samples;
  all.worst_m = std::max(all.worst_m, f.worst_m), all.worst_rad = std::max(all.worst_rad, f.worst_rad);
}

/// Drives, and tells now and then how it stands. False where the vehicle comes to no end: something stands in
/// its way for ever.
bool drive(test::LocalizationTrial& trial, double metres) {
  constexpr double kTell_s = 120.0;
  const double end_m = trial.floor().driven_m() + metres;
  int idle = 0;
  for (double before_m = 0.0; idle < 5; before_m = trial.floor().driven_m()) {
    const bool done = trial.drive(end_m - trial.floor().driven_m(), kTell_s);
    const auto& f = trial.figures();
    const auto at = trial.floor().truth();
    std::fprintf(stderr, "  %.0f m in %.0f s at (%.1f, %.1f), RMSE %.4f m, lost %d times\n", f.driven_m,
                 f.simulated_s, at.x_m(), at.y_m(), f.rmse_m(), f.losses);
    if (done) return true;
    idle = f.driven_m - before_m < 1.0 ? idle + 1 : 0;
  }
  return false;
}

/// Runs of some metres, each on a day of its own.
int accuracy(const Arguments& a) {
  test::TrialFigures all;
  const auto begin = Clock::now();
  for (int run = a.first; run < a.first + a.runs; ++run) {
    const auto setup = setup_of(a, run);
    const auto began = Clock::now();
    test::LocalizationTrial trial(setup, a.seed + static_cast<unsigned>(run));
    if (!drive(trial, a.metres)) std::printf("run %d: the way stays blocked\n", run);
    print(("run " + std::to_string(run)).c_str(), trial.figures(), seconds_since(began));
    add(all, trial.figures());
  }
  print("all", all, seconds_since(begin));
  return all.losses > 0 ? 1 : 0;
}

/// As `madori scale --self-calibration --apply` after a drive that learned: the scale is given to the drawing
/// where it is certain to 0.3 %. From then on a metre of the drawing has to be a true one.
bool calibrate(const localization::SelfCalibration& found, test::TrialSetup& setup) {
  constexpr double kCertainEnough = 0.003;
  if (!found.converged || found.uniform_sigma() > kCertainEnough) {
    std::printf("  the scale could not be measured (%s; seems %.3f %% +- %.3f %%; %d scans on %d walls)\n",
                found.converged ? "converged" : "not converged", 100.0 * found.uniform(),
                100.0 * found.uniform_sigma(), found.keyframes, found.walls);
    return false;
  }
  const double left = setup.drawing_scale / (1.0 + found.uniform());
  std::printf(
      "  the drawing seems %.3f %% +- %.3f %% too large (x %.3f, y %.3f, skew %.3f deg; %d scans on %d "
      "walls, %d of "
      "them displaced); off by %.4f %%\n",
      100.0 * found.uniform(), 100.0 * found.uniform_sigma(), 100.0 * found.strain[0],
      100.0 * found.strain[1], to_deg(found.strain[2]), found.keyframes, found.walls, found.displaced,
      100.0 * (left - 1.0));
  test::scale_drawing(setup, 1.0 / (1.0 + found.uniform()));
  setup.drawing_scale = 1.0;
  return true;
}

/// Drives on the drawing as it is, calibrates it by what was learned, and drives on it anew.
int calibrated(const Arguments& a) {
  test::TrialFigures before, after;
  int uncalibrated = 0;
  const auto begin = Clock::now();
  for (int run = a.first; run < a.first + a.runs; ++run) {
    auto setup = setup_of(a, run);
    const auto began = Clock::now();
    test::LocalizationTrial learning(setup, a.seed + static_cast<unsigned>(run));
    localization::DrawingLearner learner(setup.drawing);
    learning.learner = &learner;
    if (!drive(learning, a.learn_metres)) std::printf("run %d: the way stays blocked\n", run);
    print(("learn " + std::to_string(run)).c_str(), learning.figures(), seconds_since(began));
    add(before, learning.figures());
    if (!calibrate(learner.calibrate(), setup)) {
      ++uncalibrated;
      continue;
    }
    const auto again = Clock::now();
    test::LocalizationTrial trial(setup, a.seed + 1000 + static_cast<unsigned>(run));
    if (!drive(trial, a.metres)) std::printf("run %d: the way stays blocked\n", run);
    print(("run " + std::to_string(run)).c_str(), trial.figures(), seconds_since(again));
    add(after, trial.figures());
  }
  print("learning", before, seconds_since(begin));
  print("after", after, seconds_since(begin));
  return after.losses > 0 || uncalibrated > 0 ? 1 : 0;
}

/// Vehicles are carried away; how soon they know it.
int kidnappings(const Arguments& a) {
  const auto setup = setup_of(a, 0);
  test::LocalizationTrial trial(setup, a.seed);
  test::Kidnapper kidnapper(trial, a.seed);
  int late = 0, unfound = 0;
  double slowest_s = 0.0, wrong_s = 0.0;
  const auto begin = Clock::now();
  for (int i = 0; i < a.count; ++i) {
    const auto k = kidnapper.carry_out(a.kind < 0 ? i : 4 * i + a.kind);
    const bool is_late = !k.followed() && (k.lost_after_s < 0.0 || k.lost_after_s > 2.0);
    late += is_late;
    unfound += k.found_after_s < 0.0;
    slowest_s = std::max(slowest_s, k.lost_after_s);
    wrong_s = std::max(wrong_s, k.believed_wrong_s);
    if (a.verbose || is_late || k.found_after_s < 0.0)
      std::printf(
          "%3d kind %d %s by %5.2f m from (%.2f, %.2f, %.0f deg) to (%.2f, %.2f, %.0f deg): LOST after %.2f "
          "s, "
          "found after %.2f s, believed wrong %.2f s\n",
          i, k.kind, k.drives ? "driving " : "standing", k.by_m, k.from.x_m(), k.from.y_m(),
          to_deg(k.from.yaw_rad()), k.to.x_m(), k.to.y_m(), to_deg(k.to.yaw_rad()), k.lost_after_s,
          k.found_after_s, k.believed_wrong_s);
    std::fflush(stdout);
  }
  std::printf(
      "%d kidnappings: LOST within 2 s in %d, slowest %.2f s; found again within 8 s %d; longest belief "
      "in a wrong place %.2f s (%.0f x real time)\n",
      a.count, a.count - late, slowest_s, a.count - unfound, wrong_s,
      trial.figures().simulated_s / seconds_since(begin));
  return late > 0 ? 1 : 0;
}

}  // namespace
}  // namespace madori

int main(int argc, char** argv) {
  CLI::App app("Localization in the virtual factory");
  madori::Arguments arguments;
  app.require_subcommand(1);
  app.add_option("--data", arguments.data, "the project's data folder");
  app.add_option("--hidden", arguments.hidden_percent, "share of the walls behind pallets, per cent");
  app.add_option("--clutter", arguments.clutter_m, "height of what hides them, metres");
  app.add_option("--seed", arguments.seed, "of everything left to chance");
  app.add_option("--drawing-scale", arguments.drawing_scale, "metres on the drawing a true metre");
  app.add_flag("--changed", arguments.changed, "some walls moved, missing and new");
  app.add_flag("--verbose", arguments.verbose, "more lines");
  CLI::App* accuracy = app.add_subcommand("accuracy", "position and heading errors");
  accuracy->add_option("--runs", arguments.runs, "each on another day");
  accuracy->add_option("--metres", arguments.metres, "of each run");
  CLI::App* calibrated =
      app.add_subcommand("calibrate", "errors before and after the drawing's scale was measured by driving");
  calibrated->add_option("--runs", arguments.runs, "each on another day");
  calibrated->add_option("--first", arguments.first, "day to begin with");
  calibrated->add_option("--learn-metres", arguments.learn_metres, "on the drawing as it is");
  calibrated->add_option("--metres", arguments.metres, "on the calibrated one");
  CLI::App* kidnap = app.add_subcommand("kidnap", "time until a carried-off vehicle is LOST");
  kidnap->add_option("--count", arguments.count, "kidnappings");
  kidnap->add_option("--kind", arguments.kind,
                     "only 0: by 1 m, 1: by 1 to 5 m, 2: by 5 to 50 m, 3: to a place that looks alike");
  CLI11_PARSE(app, argc, argv);
  try {
    if (calibrated->parsed()) return madori::calibrated(arguments);
    return kidnap->parsed() ? madori::kidnappings(arguments) : madori::accuracy(arguments);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_factory: %s\n", e.what());
    return 1;
  }
}
