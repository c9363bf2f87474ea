// Absolute localization, one scan at a time. Without arguments: the tables of Kis et al. (2021) in the
// made-up hall of 200 m2. With a site's walls.csv: 500 random poses on it at 30 % clutter. Times are CPU time
// of one core.
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "tests/support/hall_trials.hpp"

namespace madori::bench {
namespace {

using namespace madori::localization;

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

void print_row(const char* what, double value, const mapping::Walls& walls, const GlobalLocalizer& global,
               const test::TrialSettings& settings) {
  std::vector<double> ms;
  const test::TrialResult r = test::run_trials(walls, global, settings, 2021, [&](auto&& locate) {
    const double started = cpu_ms();
    locate();
    ms.push_back(cpu_ms() - started);
  });
  std::sort(ms.begin(), ms.end());
  std::printf(
      "%s = %.1f m  right %5.1f %%  sure and right %5.1f %%  sure and wrong %d  ambiguous %d  nowhere %d  "
      "e_psr %.3f m (std %.3f)  median %.1f ms\n",
      what, value, 100.0 * r.right / settings.poses, 100.0 * r.found / settings.poses, r.wrong_sure,
      r.ambiguous, r.nowhere, r.e_psr_mean_m, r.e_psr_std_m, ms[ms.size() / 2]);
}

void hall_tables() {
  const mapping::Walls walls = test::laboratory_hall();
  const mapping::DistanceField field(walls);
  std::puts("Table 1, noise on x and y (paper: 100, 100, 90, 80 %)");
  const GlobalLocalizer global(walls);
  for (const double sigma : {0.0, 0.1, 0.2, 0.3}) {
    test::TrialSettings settings;
    settings.sigma_m = sigma;
    print_row("sigma", sigma, walls, global, settings);
  }
  std::puts(
      "Table 2, spacing of the candidate places; 1 cm noise, 15 % clutter (paper, real scans: 98.6, 97.1, "
      "92.8 %)");
  for (const double spacing : {0.2, 0.5, 0.8}) {
    PlaceIndexOptions options;
    options.spacing_m = spacing;
    const GlobalLocalizer spaced(walls, PlaceIndex(walls, field, options));
    test::TrialSettings settings;
    settings.sigma_m = 0.01;
    settings.clutter = 0.15;
    print_row("g", spacing, walls, spaced, settings);
  }
}

void factory_table(const char* file, double least_view_m) {
  const mapping::Walls walls = mapping::load_walls(file);
  const GlobalLocalizer global(walls);
  test::TrialSettings settings;
  settings.poses = 500;
  settings.sigma_m = 0.01;
  settings.clutter = 0.3;
  settings.scan.range_max_m = 60.0;
  settings.least_view_m = least_view_m;
  std::puts("270 degrees, 540 beams");
  print_row("view", least_view_m, walls, global, settings);
  settings.scan = test::full_turn(720, 60.0);
  std::puts("360 degrees, 720 beams");
  print_row("view", least_view_m, walls, global, settings);
}

}  // namespace
}  // namespace madori::bench

int main(int argc, char** argv) {
  if (argc > 1)
    madori::bench::factory_table(argv[1], argc > 2 ? std::atof(argv[2]) : 6.0);
  else
    madori::bench::hall_tables();
  return 0;
}
