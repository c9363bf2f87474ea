#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "app/braking/braking_run.hpp"
#include "app/commands.hpp"
#include "app/commands/within.hpp"
#include "app/cycle/site_config.hpp"
#include "app/json_output.hpp"
#include "app/runner/interruption.hpp"

namespace madori::app {
namespace {

struct BrakingArguments {
  BrakingRunOptions run;
  bool with_load = false, apply = false, lower_speed = false;
  std::string json_file;
};

void print(const std::vector<BrakingStop>& stops, const BrakingVerdict& verdict,
           const mapping::VehicleRecord& record, std::FILE* stream) {
  std::fputs("load     from        braking      latency   way\n", stream);
  for (const auto& [loaded, stop] : stops)
    std::fprintf(stream, "%-8s %.2f m/s   %.3f m/s2   %.3f s   %.3f m\n", loaded ? "loaded" : "empty",
                 stop.speed_mps, stop.deceleration_mps2, stop.latency_s, stop.way_m);
  std::fprintf(
      stream, "to be recorded: max_deceleration_mps2 %.2f, reaction_s %.2f%s\n", verdict.deceleration_mps2,
      verdict.reaction_s,
      std::ranges::none_of(stops, &BrakingStop::loaded) ? " (better values only count with a load)" : "");
  std::fprintf(stream, "site.yaml: max_deceleration_mps2 %.2f, reaction_s %.2f\n",
               record.max_deceleration_mps2, record.reaction_s);
  std::fprintf(stream, "at %.2f m/s the vehicle needs %.2f m to stand; the lidar is sure to %.2f m: %s\n",
               record.max_speed_mps, verdict.needs_m, verdict.sees_m,
               outruns(verdict, record.max_speed_mps) ? "too fast" : "enough");
}

nlohmann::json report(const std::vector<BrakingStop>& stops, const BrakingVerdict& verdict,
                      const mapping::VehicleRecord& record, bool applied) {
  auto list = nlohmann::json::array();
  for (const auto& [loaded, stop] : stops)
    list.push_back({{"loaded", loaded},
                    {"speed_mps", stop.speed_mps},
                    {"deceleration_mps2", stop.deceleration_mps2},
                    {"latency_s", stop.latency_s},
                    {"way_m", stop.way_m}});
  return {{"stops", list},
          {"max_deceleration_mps2", verdict.deceleration_mps2},
          {"reaction_s", verdict.reaction_s},
          {"needs_m", verdict.needs_m},
          {"sees_m", verdict.sees_m},
          {"allowed_speed_mps", verdict.allowed_mps},
          {"outruns_lidar", outruns(verdict, record.max_speed_mps)},
          {"applied", applied}};
}

void run(BrakingArguments& arguments) {
  expect_json(arguments.json_file);
  const auto& folder = arguments.run.site;
  const SiteForDriving loaded = load_for_driving(folder);
  const mapping::VehicleRecord& record = loaded.site.vehicle;
  std::FILE* stream = arguments.json_file == "-" ? stderr : stdout;
  if (arguments.with_load)
    arguments.run.load = [stream] {
      std::fputs("put the load on, then press Enter\n", stream);
      std::string line;
      return static_cast<bool>(std::getline(std::cin, line));
    };
  const auto stops = run_braking_test(arguments.run, interrupted_by({SIGINT, SIGTERM, SIGHUP}));
  const auto verdict = verdict_of(stops, braking_site(loaded.config));
  if (!verdict) return;
  print(stops, *verdict, record, stream);
  bool applied = false;
  const auto tell = [&] { write_json(arguments.json_file, report(stops, *verdict, record, applied)); };
  if (arguments.apply) try {
      take_over(folder, *verdict, arguments.lower_speed);
      applied = true;
    } catch (...) {  // what was measured is told all the same
      tell();
      throw;
    }
  tell();
  std::fputs(applied ? "site.yaml holds the measured values now\n"
                     : "nothing was changed; add --apply to write the measured values into site.yaml\n",
             stream);
}

}  // namespace

void add_braking_test(CLI::App& app) {
  auto arguments = std::make_shared<BrakingArguments>();
  CLI::App* command = app.add_subcommand(
      "braking-test", "drive, stop and measure: deceleration and latency of the site's vehicle");
  command->add_option("DIR", arguments->run.site, "site folder")->required();
  add_device_options(*command, arguments->run.devices);
  command->add_option("--speed", arguments->run.speed_mps, "m/s (default: the site's top speed)")
      ->check(within(0.1, 5.0));
  command->add_option("--stops", arguments->run.stops, "of each series")
      ->check(within(1, 20))
      ->capture_default_str();
  command->add_flag("--with-load", arguments->with_load,
                    "a second series with the load on: it is waited for (Enter)");
  command->add_flag("--apply", arguments->apply, "write the worst measured values into site.yaml");
  command->add_flag("--lower-speed", arguments->lower_speed,
                    "with --apply: lower a top speed that would outrun the lidar");
  command->add_option("--json", arguments->json_file, "write the figures to a file; - for stdout");
  command->callback([arguments] {
    std::fputs("The vehicle drives by itself: keep its way free, and stand by the emergency stop.\n", stderr);
    run(*arguments);
  });
}

}  // namespace madori::app
