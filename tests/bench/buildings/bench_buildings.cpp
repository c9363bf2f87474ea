// Drives from the drawing in buildings that are not as drawn: the whole cycle in lock-step, the devices' own
// bytes, no pose given, an operator who taps at most once. docs/reference/buildings-figures.md says what is
// measured. Exit 1 where a drive could not be made at all. With --random N: localization alone in random
// buildings whose drawing is bent by a known warp.
//   bench_buildings [../shared/data/buildings] [--only hotel_L1/start0] [--jobs 2] [--json FILE] [--csv FILE]
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>

#include "app/commands/within.hpp"
#include "core/result.hpp"
#include "tests/bench/buildings/bent_campaign.hpp"
#include "tests/bench/buildings/building_drive.hpp"
#include "tests/bench/buildings/drive_report.hpp"
#include "tests/bench/buildings/jobs.hpp"
#include "tests/bench/buildings/pose_source_choice.hpp"
#include "tests/bench/buildings/trial_localizer.hpp"

namespace madori::bench {
namespace {

struct Arguments {
  std::filesystem::path buildings = std::string(MADORI_SHARED_DATA) + "/buildings";
  std::string only;
  DriveOptions drive;
  BentCampaign bent;
  int jobs = 1;
  std::string json_file, csv_file;
};

std::vector<nlohmann::json> drive_all(const Arguments& a) {
  std::vector<Job> jobs;
  for (const BuildingStart& start : list_starts(a.buildings, a.only))
    jobs.push_back({start.name, [start, &a] { return to_json(BuildingDrive(start, a.drive).drive()); }});
  std::vector<nlohmann::json> figures;
  run_jobs(jobs, a.jobs, [&](const nlohmann::json& f) {
    print_row(f);
    figures.push_back(f);
  });
  std::sort(figures.begin(), figures.end(),
            [](const auto& x, const auto& y) { return x["name"] < y["name"]; });
  return figures;
}

int run(Arguments a) {
  if (a.bent.count > 0) {
    a.bent.trial.source = a.drive.source;
    return drive_bent_buildings(a.bent, a.jobs, a.json_file);
  }
  if (!a.drive.trace.empty()) std::filesystem::create_directories(a.drive.trace);
  print_head();
  const auto figures = drive_all(a);
  print_sums(figures);
  if (!a.json_file.empty()) std::ofstream(a.json_file) << nlohmann::json(figures).dump(1) << '\n';
  if (!a.csv_file.empty()) std::ofstream(a.csv_file) << to_csv(figures);
  return std::any_of(figures.begin(), figures.end(),
                     [](const auto& f) { return !f.value("error", "").empty(); });
}

void add_random_options(CLI::App& app, BentCampaign& bent) {
  app.add_option("--random", bent.count, "random bent buildings at each amplitude, by as many seeds");
  app.add_option("--first-seed", bent.first_seed, "constants are chosen below 1001")->capture_default_str();
  app.add_option("--amplitudes", bent.amplitudes_m, "largest displacement of the drawing, metres")
      ->delimiter(',');
  app.add_option("--sensors", bent.sensors, "vlp16, scan")
      ->delimiter(',')
      ->check(CLI::IsMember({"vlp16", "scan"}));
  app.add_option("--metres", bent.trial.metres, "driven in each")->capture_default_str();
  app.add_flag("!--no-tap", bent.trial.tap, "the place is not given, but sought");
  app.add_option("--samples", bent.samples_file,
                 "file of what was said and what was right, for plot_reliability.py");
}

}  // namespace
}  // namespace madori::bench

int main(int argc, char** argv) {
  CLI::App app("Driving from the drawing in buildings that are not as drawn");
  madori::bench::Arguments a;
  app.add_option("BUILDINGS", a.buildings, "folder of buildings with a README")->capture_default_str();
  app.add_option("--only", a.only, "parts of starts' names, comma between");
  auto sources = madori::bench::localizer_names();
  sources.emplace_back(madori::bench::kTruth);
  app.add_option("--source", a.drive.source, "what localizes; truth: nothing does, for comparison")
      ->check(CLI::IsMember(sources))
      ->capture_default_str();
  app.add_option("--sensor", a.drive.sensor, "what it localizes with; scan: a 2D scanner in process")
      ->check(CLI::IsMember({"vlp16", "scan"}))
      ->capture_default_str();
  app.add_option("--seed", a.drive.seed, "order of stations, and how taps are off")->capture_default_str();
  app.add_option("--laps", a.drive.laps, "visits of all stations")->capture_default_str();
  app.add_option("--limit-s", a.drive.limit_s, "simulated seconds for one delivery")->capture_default_str();
  app.add_option("--jobs", a.jobs, "processes at once")
      ->check(madori::app::within(1, 64))
      ->capture_default_str();
  app.add_option("--hand-made", a.drive.hand_made,
                 "folder: BUILDING/walls.csv, marked in the drawing by hand, in place of the imported walls");
  app.add_option("--trace", a.drive.trace,
                 "folder of a CSV a start: truth, pose, state, five times a second");
  app.add_option("--json", a.json_file, "file of all figures");
  app.add_option("--csv", a.csv_file, "file of a line a start");
  madori::bench::add_random_options(app, a.bent);
  CLI11_PARSE(app, argc, argv);
  spdlog::set_level(spdlog::level::off);
  try {
    return madori::bench::run(a);
  } catch (const madori::Error& e) {
    std::fprintf(stderr, "bench_buildings: %s\n", e.what());
    return 1;
  }
}
