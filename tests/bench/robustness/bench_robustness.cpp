// How the localizer stands harm: real logs on drawings that are wrong, from starts that are wrong, with
// wheels and scans made worse. One configuration for all of them. Needs the data folder
// (docs/reference/benchmarks.md).
//   bench_robustness [DATA/lidar2d [parts of cases' names, comma between [folder for a file of every scan's
//   errors]]]
// Columns: longest run of scans off by more than 2 m; position median and p95, metres; heading mean, degrees;
// share within 0.5 m and 10 degrees; shares of the time in each state; scans LOCALIZED while over 1.5 m off;
// mean of the relations, metres. Drawings of fr079 and aces are lines seen in the log itself, then made
// wrong.
#include <cstdio>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>

#include "app/trajectory_score.hpp"
#include "core/result.hpp"
#include "tests/bench/robustness/trial.hpp"

namespace madori::bench {
namespace {

void print_case(const Building& building, const Case& c, const std::filesystem::path& scans,
                localization::Memory& memory) {
  const Outcome out = play(building, c, memory);
  if (!scans.empty()) std::ofstream(scans / (building.name + " " + c.name + ".csv")) << out.scans;
  const auto score = app::score_against_truth(out.trajectory, truth_of(building, c));
  double relations = 0.0;
  if (!c.log.reversed && std::filesystem::exists(building.relations)) {
    relations = app::score_against_relations(
        out.trajectory, app::load_relations(building.relations))["translation_m"]["mean"];
  }
  const auto share = [&](LocalizationState s) { return 100.0 * out.health.share(s); };
  std::printf(
      "%-26s %4d %6.3f %6.3f %6.2f %5.1f | %5.1f %5.1f %5.1f %5.1f %4d %5.2f | %6.3f | %5.1f %5.1f | %4zu "
      "%4zu %5.2f\n",
      (building.name + "/" + c.name).c_str(), out.longest_lost, score["position_m"]["median"].get<double>(),
      score["position_m"]["p95"].get<double>(), score["heading_deg"]["mean"].get<double>(),
      100.0 * score["within"]["share"].get<double>(), share(LocalizationState::Localized),
      share(LocalizationState::Degraded), share(LocalizationState::Ambiguous), share(LocalizationState::Lost),
      out.wrongly_sure, out.worst_sure_m, relations, out.p50_ms, out.p99_ms, memory.size(),
      memory.factors().size(), 1e-6 * static_cast<double>(memory.bytes()));
  std::fflush(stdout);
}

class Table {
 public:
  Table(std::filesystem::path folder, std::string filter, std::filesystem::path scans)
      : folder_(std::move(folder)), filter_(std::move(filter)), scans_(std::move(scans)) {
    std::printf("%-26s %4s %6s %6s %6s %5s | %5s %5s %5s %5s %4s %5s | %6s | %5s %5s | %4s %4s %5s\n", "case",
                "lost", "median", "p95", "head", "in %", "LOC", "DEG", "AMB", "LOST", "sure", "worst",
                "relat.", "p50ms", "p99ms", "keyf", "ties", "MB");
  }

  void run(const std::string& name, const std::function<Building()>& make, const std::vector<Case>& cases) {
    std::optional<Building> building;
    for (const Case& c : cases) {
      if (!wanted(name + "/" + c.name)) continue;
      if (!building) building = make();
      building->name = name;
      localization::Memory memory;
      for (int lap = 0; lap < c.laps; ++lap) print_case(*building, c, scans_, memory);
    }
  }

  void all() {
    const auto real = [this] { return intel(folder_); };
    run("intel", real,
        {{.name = "mapping", .start_x_m = 0.0, .start_y_m = 0.0, .start_deg = 0.0, .has_drawing = false}});
    run("intel", real, ten_starts());
    run("intel", real, log_harms());
    run("intel", real, drawing_harms());
    for (const int px : {2, 4}) {
      run("intel", [&] { return intel(folder_, "layout.png", {.blur_px = px}); },
          {{.name = "blur " + std::to_string(px)}});
    }
    for (const int px : {-3, -2, 1}) {
      run("intel", [&] { return intel(folder_, "layout.png", {.thinner_px = px}); },
          {{.name = "thinner " + std::to_string(px)}});
    }
    run("mirrored", [this] { return intel(folder_, "layout_mirrored.png"); }, {{.name = "start"}});
    for (const std::string name : {"fr079", "aces"}) {
      const auto own = [this, name] { return with_own_drawing(folder_, name); };
      run(name, own,
          {{.name = "mapping", .start_x_m = 0.0, .start_y_m = 0.0, .start_deg = 0.0, .has_drawing = false}});
      run(name, own, rough_drawings());
      run(name, own, log_harms());
      run(name, own, drawing_harms());
    }
  }

 private:
  /// Any of the parts of names, which are separated by commas.
  [[nodiscard]] bool wanted(const std::string& name) const {
    std::istringstream parts(filter_);
    for (std::string part; std::getline(parts, part, ',');) {
      if (name.find(part) != std::string::npos) return true;
    }
    return filter_.empty();
  }

  std::filesystem::path folder_;
  std::string filter_;
  std::filesystem::path scans_;
};

}  // namespace
}  // namespace madori::bench

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : std::string(MADORI_SHARED_DATA) + "/lidar2d";
  try {
    madori::bench::Table(folder, argc > 2 ? argv[2] : "", argc > 3 ? argv[3] : "").all();
  } catch (const madori::Error& e) {
    std::fprintf(stderr, "bench_robustness: %s\n", e.what());
    return 1;
  }
}
