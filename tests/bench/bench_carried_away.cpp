// Logs cut into pieces that are joined in another order: at each joint the vehicle is carried to another
// place, and neither wheels nor stamps tell of it. What the graph mapper makes of it, beside its map of the
// whole log at the same moments. `bench_carried_away FOLDER [log,log,… [first seed [count [every]]]]`, every:
// only every n-th scan arrives.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "app/mapping_run.hpp"
#include "app/trajectory_score.hpp"
#include "localization/slam/graph_mapper.hpp"
#include "tests/support/mapped_way.hpp"

namespace madori::bench {
namespace {

constexpr std::size_t kTimes = 10;

using test::Way;

/// What is known of a log besides its scans.
struct Truth {
  Way reference;
  std::vector<app::Relation> relations;
};

struct Mapped {
  Way way;
  app::MappingRun run;
};

Way at_moments_of(const Way& way, const Way& moments) {
  std::set<Stamp> stamps;
  for (const auto& pose : moments) stamps.insert(pose.stamp);
  Way some;
  std::copy_if(way.begin(), way.end(), std::back_inserter(some),
               [&](const app::StampedPose& pose) { return stamps.contains(pose.stamp); });
  return some;
}

std::string score(Way way, const Truth& truth) {
  if (way.empty()) return "–";
  char text[120];
  test::lay_on(way, truth.reference);
  const auto off = app::score_against_truth(way, truth.reference)["position_m"];
  std::snprintf(text, sizeof text, "%.3f, %.2f m", off["mean"].get<double>(), off["max"].get<double>());
  std::string all = text;
  if (truth.relations.empty()) return all;
  const auto relations = app::score_against_relations(way, truth.relations)["translation_m"];
  std::snprintf(text, sizeof text, "; %.4f m", relations["mean"].get<double>());
  return all + text;
}

void run(const std::filesystem::path& folder, const std::string& name, unsigned first, unsigned count,
         int every) {
  const auto records = test::records_of(folder / name / (name + ".log"), every);
  Truth truth;
  truth.reference = app::load_tum(folder / name / "reference.tum");
  if (const auto file = folder / name / (name + ".relations"); std::filesystem::exists(file))
    truth.relations = app::load_relations(file);
  const auto mapped_of = [&](std::size_t times, unsigned seed) {
    test::CutLog log(records, times, seed);
    localization::GraphMapper mapper;
    Mapped mapped;
    mapped.way = test::mapped_way(log, mapper, mapped.run);
    return mapped;
  };
  const auto tell = [&](const std::string& order, const Mapped& mapped, const std::string& beside) {
    const std::size_t scans = mapped.run.map.scans.size();
    std::printf("| %s, %s | %zu | %zu of %zu | %s | %s |\n", name.c_str(), order.c_str(),
                mapped.run.map.carried.size(), scans,
                scans + static_cast<std::size_t>(mapped.run.map.lost_scans), score(mapped.way, truth).c_str(),
                beside.c_str());
    std::fflush(stdout);
  };
  const Mapped whole = mapped_of(0, 0);
  tell("whole", whole, "");
  for (unsigned seed = first; seed < first + count; ++seed) {
    const Mapped mapped = mapped_of(kTimes, seed);
    tell(std::to_string(seed), mapped, score(at_moments_of(whole.way, mapped.way), truth));
  }
}

}  // namespace
}  // namespace madori::bench

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "bench_carried_away FOLDER [log,log,… [first seed [count [every]]]]\n");
    return 2;
  }
  std::istringstream names(argc > 2 ? argv[2] : "intel,aces,fr079");
  const auto first = static_cast<unsigned>(argc > 3 ? std::atoi(argv[3]) : 1);
  const auto count = static_cast<unsigned>(argc > 4 ? std::atoi(argv[4]) : 5);
  const int every = argc > 5 ? std::max(1, std::atoi(argv[5])) : 1;
  std::puts(
      "| log, order | cuts found | scans in the map | off the reference, mean, largest; relations | whole "
      "log, same moments |");
  std::puts("| --- | --- | --- | --- | --- |");
  for (std::string name; std::getline(names, name, ',');)
    madori::bench::run(argv[1], name, first, count, every);
  return 0;
}
