// People and forklifts: who the obstacle check believes to move, against the virtual factory's truth, beside
// a nearest-neighbour baseline on the same scans. docs/reference/movers-figures.md says how they are
// compared.
//   bench_movers SITE... [--seeds 2,3,4] [--minutes 10] [--threshold 0.2] [--json FILE]
//   bench_movers SITE... --seeds 1 --tune       the baseline's threshold: F1 within 8 m of each that is tried
// SITE: made by tests/end_to_end/sample_site.py, one a setup of lidars. The same arguments give the same
// figures.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/json_output.hpp"
#include "tests/bench/movers/mover_drive.hpp"
#include "tests/bench/movers/mover_report.hpp"

namespace madori::bench {
namespace {

const std::vector<double> kTried{0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0};

struct Arguments {
  std::vector<std::string> sites;
  std::vector<unsigned> seeds{2, 3, 4};
  std::string json_file;
  bool tune = false;
  double threshold_mps = 0.2;  ///< chosen on seed 1: docs/reference/movers-figures.md
  DriveOptions drive;
};

void add(DriveScores& sum, const DriveScores& one) {
  sum.tracker.merge(one.tracker);
  sum.baseline.resize(one.baseline.size());
  for (std::size_t i = 0; i < one.baseline.size(); ++i) sum.baseline[i].merge(one.baseline[i]);
  sum.looks += one.looks;
  sum.driven_m += one.driven_m;
  sum.orders += one.orders;
  sum.helps += one.helps;
}

DriveScores drive_all(const Arguments& a, const std::string& site) {
  DriveScores sum;
  for (const unsigned seed : a.seeds) {
    DriveOptions options = a.drive;
    options.site = site;
    options.seed = seed;
    options.thresholds_mps = a.tune ? kTried : std::vector{a.threshold_mps};
    const DriveScores one = MoverDrive(options).drive();
    fmt::print(stderr, "{} seed {}: {} looks, {:.0f} m, {} orders, {} helps\n", site, seed, one.looks,
               one.driven_m, one.orders, one.helps);
    add(sum, one);
  }
  return sum;
}

std::string name_of(const std::string& site) {
  return std::filesystem::path(site).filename().string();
}

void tell_thresholds(const std::string& site, const DriveScores& scores) {
  fmt::print("{}: tracker F1 {:.3f}; baseline", name_of(site), f1_score(scores.tracker));
  for (std::size_t i = 0; i < kTried.size(); ++i)
    fmt::print(", {:.1f} m/s {:.3f}", kTried[i], f1_score(scores.baseline[i]));
  fmt::print("\n");
}

void run(const Arguments& a) {
  std::vector<DriveScores> all;
  for (const auto& site : a.sites) all.push_back(drive_all(a, site));
  nlohmann::json figures;
  const auto each = [&](const auto& show) {
    for (std::size_t i = 0; i < all.size(); ++i)
      show(Comparison{name_of(a.sites[i]), all[i].tracker, all[i].baseline.front(), all[i].looks});
  };
  if (a.tune) {
    for (std::size_t i = 0; i < all.size(); ++i) tell_thresholds(a.sites[i], all[i]);
  } else {
    print_told_head();
    each(print_told);
    fmt::print("\n");
    print_found_head();
    each(print_found);
  }
  each([&](const Comparison& c) {
    figures[c.setup] = {
        {"scans", c.looks}, {"tracker", to_json(c.tracker)}, {"baseline", to_json(c.baseline)}};
  });
  app::write_json(a.json_file, figures);
}

}  // namespace
}  // namespace madori::bench

int main(int argc, char** argv) {
  CLI::App app("Who moves, as the obstacle check believes, against the virtual factory's truth");
  madori::bench::Arguments a;
  app.add_option("SITE", a.sites, "site folders with a scenario, one a setup of lidars")->required();
  app.add_option("--scenario", a.drive.scenario, "file in each site's folder")->capture_default_str();
  app.add_option("--seeds", a.seeds, "a drive each")->delimiter(',');
  app.add_option("--minutes", a.drive.minutes, "simulated, of a drive")->capture_default_str();
  app.add_option("--threshold", a.threshold_mps, "m/s: faster clusters of the baseline move")
      ->capture_default_str();
  app.add_flag("--tune", a.tune, "try thresholds of the baseline");
  app.add_option("--json", a.json_file, "the figures; - for stdout");
  CLI11_PARSE(app, argc, argv);
  spdlog::set_level(spdlog::level::warn);
  try {
    madori::bench::run(a);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_movers: %s\n", e.what());
    return 1;
  }
}
