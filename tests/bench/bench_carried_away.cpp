// Logs cut into pieces that are joined in another order: at each joint the vehicle is carried to another
// place, and neither wheels nor stamps tell of it. What the graph mapper makes of it, beside its map of the
// whole log at the same moments. `bench_carried_away FOLDER [log,log,… [first seed [count]]]`
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
#include "tests/support/cut_log.hpp"
#include "tests/support/lidar_models.hpp"
#include "tests/support/rigid_fit.hpp"

namespace madori::bench {
namespace {

constexpr std::size_t kTimes = 10;

using Way = std::vector<app::StampedPose>;

/// What is known of a log besides its scans.
struct Truth {
  Way reference;
  std::vector<app::Relation> relations;
};

Way way_of(const app::MappingRun& run) {
  Way way;
  for (const auto& pose : run.at_last) way.push_back({pose.stamp, pose.map_from_base});
  return way;
}

Way at_moments_of(const Way& way, const Way& moments) {
  std::set<Stamp> stamps;
  for (const auto& pose : moments) stamps.insert(pose.stamp);
  Way some;
  std::copy_if(way.begin(), way.end(), std::back_inserter(some),
               [&](const app::StampedPose& pose) { return stamps.contains(pose.stamp); });
  return some;
}

/// Laid rigidly on the reference.
Way laid_on(Way way, const Way& reference) {
  std::vector<std::pair<Point2<Map>, Point2<Map>>> pairs;
  for (const auto& r : reference) {
    const auto at = std::lower_bound(way.begin(), way.end(), r.stamp - duration_from_seconds(0.02),
                                     [](const auto& p, Stamp s) { return p.stamp < s; });
    if (at != way.end() && at->stamp <= r.stamp + duration_from_seconds(0.02))
      pairs.emplace_back(at->map_from_base.translation(), r.map_from_base.translation());
  }
  const auto by = test::fit_rigidly(pairs);
  for (auto& pose : way) pose.map_from_base = by * pose.map_from_base;
  return way;
}

std::string score(Way way, const Truth& truth) {
  std::stable_sort(way.begin(), way.end(), [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  char text[120];
  const auto off = app::score_against_truth(laid_on(way, truth.reference), truth.reference)["position_m"];
  std::snprintf(text, sizeof text, "%.3f, %.2f m", off["mean"].get<double>(), off["max"].get<double>());
  std::string all = text;
  if (truth.relations.empty()) return all;
  const auto relations = app::score_against_relations(way, truth.relations)["translation_m"];
  std::snprintf(text, sizeof text, "; %.4f m", relations["mean"].get<double>());
  return all + text;
}

void run(const std::filesystem::path& folder, const std::string& name, unsigned first, unsigned count) {
  const auto records = test::records_of(folder / name / (name + ".log"));
  Truth truth;
  truth.reference = app::load_tum(folder / name / "reference.tum");
  if (const auto file = folder / name / (name + ".relations"); std::filesystem::exists(file))
    truth.relations = app::load_relations(file);
  const LidarModel lidar = test::planar_lidar({0.0, 0.0, 0.3, 0.0});
  Way whole;
  {
    test::CutLog log(records, 0, 0);
    localization::GraphMapper mapper;
    const auto mapped = app::run_mapper(log, lidar, mapper);
    whole = way_of(mapped);
    for (auto& pose : whole) pose.stamp = log.recorded(pose.stamp);
    std::printf("| %s, whole | - | %zu of %zu | %s | |\n", name.c_str(), mapped.map.scans.size(),
                mapped.map.scans.size() + static_cast<std::size_t>(mapped.map.lost_scans),
                score(whole, truth).c_str());
  }
  for (unsigned seed = first; seed < first + count; ++seed) {
    test::CutLog log(records, kTimes, seed);
    localization::GraphMapper mapper;
    const auto mapped = app::run_mapper(log, lidar, mapper);
    Way way = way_of(mapped);
    for (auto& pose : way) pose.stamp = log.recorded(pose.stamp);
    std::printf("| %s, %u | %zu | %zu of %zu | %s | %s |\n", name.c_str(), seed, mapped.map.carried.size(),
                mapped.map.scans.size(),
                mapped.map.scans.size() + static_cast<std::size_t>(mapped.map.lost_scans),
                score(way, truth).c_str(), score(at_moments_of(whole, way), truth).c_str());
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace madori::bench

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "bench_carried_away FOLDER [log,log,… [first seed [count]]]\n");
    return 2;
  }
  std::istringstream names(argc > 2 ? argv[2] : "intel,aces,fr079");
  const auto first = static_cast<unsigned>(argc > 3 ? std::atoi(argv[3]) : 1);
  const auto count = static_cast<unsigned>(argc > 4 ? std::atoi(argv[4]) : 5);
  std::puts(
      "| log, order | cuts found | scans in the map | off the reference, mean, largest; relations | whole "
      "log, same moments |");
  std::puts("| --- | --- | --- | --- | --- |");
  for (std::string name; std::getline(names, name, ',');) madori::bench::run(argv[1], name, first, count);
  return 0;
}
