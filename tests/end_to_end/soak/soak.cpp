// Deliveries in the virtual factory, lock-step, with real localization, over days on which the factory
// changes; docs/reference/driving-figures.md holds the figures with the command. Every day is printed as a
// line of JSON (--json), an interrupted one as far as it went; report.py adds days up. Exit 1 where an order
// was not delivered, the vehicle ran into something, or somebody had to help although another way was free.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/end_to_end/soak/working_day.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::soak {
namespace {

std::atomic<bool> interrupted = false;  // NOLINT: a signal handler reaches nothing else

struct Arguments {
  DayOptions day;
  Wishes wishes;
  int first_day = 0;
  int end_day = -1;
  std::string json_file;
};

bool is_good(const Figures& f) {
  const bool helped_in_vain =
      std::any_of(f.help.begin(), f.help.end(), [](const Help& h) { return !h.every_way_blocked; });
  return f.undelivered.empty() && f.collisions_moving.empty() && !helped_in_vain;
}

int run(Arguments arguments) {
  const test::TemporaryFolder folder;
  if (arguments.day.database.empty()) arguments.day.database = folder.path();
  const int end = arguments.end_day < 0 ? arguments.wishes.days : arguments.end_day;
  bool good = true;
  std::signal(SIGINT, [](int) { interrupted = true; });
  std::signal(SIGTERM, [](int) { interrupted = true; });
  for (int number = arguments.first_day; number < end && !interrupted; ++number) {
    WorkingDay day(arguments.day, arguments.wishes, number);
    const Figures f = day.work(interrupted);
    good = good && is_good(f);
    std::printf(
        "day %d: %d of %d delivered, %zu + %zu collisions, %zu times help, %.0f m, %.1f x real time\n",
        number, f.delivered, f.asked, f.collisions_moving.size(), f.collisions_standing.size(), f.help.size(),
        f.driven_m, f.simulated_s / f.cpu_s);
    std::fflush(stdout);
    if (!arguments.json_file.empty()) std::ofstream(arguments.json_file, std::ios::app) << to_json(f) << '\n';
  }
  return good ? 0 : 1;
}

}  // namespace
}  // namespace madori::soak

int main(int argc, char** argv) {
  CLI::App app("Deliveries in the virtual factory, lock-step");
  madori::soak::Arguments a;
  app.add_option("SITE", a.day.site, "site folder, what madori demo --import-only makes")->required();
  app.add_option("SCENARIO", a.day.scenario, "scenario file")->required();
  app.add_option("--routes", a.day.routes, "folder of path.csv and tree.csv instead of the site's");
  app.add_option("--database", a.day.database, "folder in which madori.db is kept");
  app.add_option("--orders", a.wishes.deliveries, "deliveries over all days");
  app.add_option("--days", a.wishes.days, "on each the factory is arranged differently");
  app.add_option("--first-day", a.first_day, "drive the days from this one on");
  app.add_option("--end-day", a.end_day, "and before this one; default: all");
  app.add_option("--seed", a.wishes.seed, "of everything left to chance");
  app.add_option("--limit", a.day.limit_s, "seconds of factory time for one order");
  app.add_option("--kidnappings", a.wishes.kidnappings, "spread over all deliveries");
  app.add_option("--dropouts", a.wishes.dropouts, "of lidar, encoders and drive link in turn");
  app.add_option("--crossings", a.wishes.crossing_share, "share of the deliveries with a person crossing");
  app.add_option("--pallets", a.wishes.pallet_share, "share of the deliveries with a pallet on the way");
  app.add_option("--memory", a.day.memory, "folder in which the vehicle's memory goes on from day to day");
  app.add_option("--living-map", a.day.living_map, "folder in which the living map goes on from day to day");
  app.add_option("--json", a.json_file, "the figures of every day are appended, one line each");
  app.add_option("--trace", a.day.trace_s,
                 "FROM TO, as printed with --verbose: tell of every revolution between");
  app.add_flag("--verbose", a.day.verbose, "print every event and delivery");
  CLI11_PARSE(app, argc, argv);
  spdlog::set_level(spdlog::level::warn);
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  try {
    return madori::soak::run(a);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "soak: %s\n", e.what());
    return 1;
  }
}
