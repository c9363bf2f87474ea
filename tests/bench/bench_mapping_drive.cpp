// How right a map by driving is: random drives by hand through two rooms of the virtual factory (lock-step,
// the panel's own code), the site's walls scored as `madori evaluate --map --align anywhere` does, and the
// pieces of them that lie farther than 0.1 m from every true wall. The mends were found on seeds 1 to 20;
// 1001 to 1040 were held out.
//   bench_mapping_drive [--seed FIRST] [--count N] [--lidar vlp16|lms1xx] [--firings K] [--persons N]
//                       [--keep DIR]
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "core/median.hpp"
#include "tests/support/mapping_trial.hpp"

namespace {

void print(const madori::test::MappingTrial& trial, const madori::test::MappingTrialResult& result) {
  std::printf(
      "%6llu  %5.1f m  %3zu keyframes  %2zu walls  map to building %.3f m  building to map %.3f m  finish "
      "%.2f s",
      static_cast<unsigned long long>(trial.seed), result.driven_m, result.keyframes, result.walls,
      result.map_to_building_m, result.building_to_map_m, result.finish_s);
  std::printf(result.missed > 0 ? "  %d goals given up\n" : "\n", result.missed);
  for (const auto& [where, off_m] : result.phantoms)
    std::printf("        phantom %5.2f %5.2f - %5.2f %5.2f  %.2f m long, %.2f m off\n", where.a.x_m,
                where.a.y_m, where.b.x_m, where.b.y_m, where.length_m(), off_m);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace madori;
  test::MappingTrial trial;
  int count = 20;
  std::string lidar = "vlp16", keep;
  CLI::App line;
  line.add_option("--seed", trial.seed);
  line.add_option("--count", count)->check(CLI::PositiveNumber);
  line.add_option("--lidar", lidar)->check(CLI::IsMember({"vlp16", "lms1xx"}));
  line.add_option("--firings", trial.keep_every_firing);
  line.add_option("--persons", trial.persons);
  line.add_option("--keep", keep);
  CLI11_PARSE(line, argc, argv);
  spdlog::set_level(spdlog::level::off);
  if (lidar == "lms1xx") trial.lidar = {"front", lidar, 0.7, 0.0, 0.25, 0.0};
  std::vector<double> there, back;
  double phantom_m = 0.0;
  for (int i = 0; i < count; ++i, ++trial.seed) {
    if (!keep.empty()) trial.keep = keep + "/" + std::to_string(trial.seed);
    test::MappingTrialResult result;
    try {
      result = test::run_mapping_trial(trial);
    } catch (const app::NoMap& none) {  // persons held it where it began
      std::printf("%6llu  no map: %s\n", static_cast<unsigned long long>(trial.seed), none.what());
      continue;
    }
    print(trial, result);
    there.push_back(result.map_to_building_m);
    back.push_back(result.building_to_map_m);
    for (const auto& piece : result.phantoms) phantom_m += piece.where.length_m();
  }
  if (there.empty()) return 1;
  const int maps = static_cast<int>(there.size());
  const auto over = [](const std::vector<double>& v) {
    return std::count_if(v.begin(), v.end(), [](double m) { return m > 0.05; });
  };
  std::printf(
      "map to building: median %.3f m, largest %.3f m, over 0.05 m %d of %d; building to map: median %.3f m, "
      "largest "
      "%.3f m, over 0.05 m %d of %d; phantom pieces %.1f m\n",
      madori::median_of(there), *std::max_element(there.begin(), there.end()), static_cast<int>(over(there)),
      maps, madori::median_of(back), *std::max_element(back.begin(), back.end()),
      static_cast<int>(over(back)), maps, phantom_m);
}
