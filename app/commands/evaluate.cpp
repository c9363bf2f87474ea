#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/commands/within.hpp"
#include "app/json_output.hpp"
#include "app/map_comparison.hpp"
#include "app/pose_argument.hpp"
#include "app/trajectory_score.hpp"

namespace madori::app {
namespace {

struct EvaluateArguments {
  std::string trajectory;
  std::string truth;
  std::string relations;
  std::string map_from_reference;
  std::string json_file;
  std::string map;
  std::string building;
  std::string start;
  MapComparisonOptions comparison;
};

void evaluate_map(const EvaluateArguments& arguments) {
  constexpr double kFarthestM = 1e6;
  MapComparisonOptions options = arguments.comparison;
  if (!arguments.start.empty()) {
    const auto start = parse_pose("--start", arguments.start);
    if (std::hypot(start.x_m(), start.y_m()) > kFarthestM)
      throw CLI::ValidationError("--start", "'" + arguments.start + "' lies more than 1000 km away");
    options.start = {start.x_m(), start.y_m(), start.yaw_rad()};
  }
  const nlohmann::json found = compare_maps(occupied_places(arguments.map, options.cell_m),
                                            occupied_places(arguments.building, options.cell_m), options);
  write_json(arguments.json_file, found);
  if (arguments.json_file == "-") return;
  const auto line = [](const char* what, const nlohmann::json& d) {
    std::printf("%s: mean %.3f m, median %.3f m, p95 %.3f m, within 0.2 m %.1f %% of %zu places\n", what,
                d["mean_m"].get<double>(), d["median_m"].get<double>(), d["p95_m"].get<double>(),
                100.0 * d["share_within_0_2_m"].get<double>(), d["places"].get<std::size_t>());
  };
  line("building to map", found["building_to_map"]);
  line("map to building", found["map_to_building"]);
  const auto& laid = found["building_from_map"];
  std::printf("the map was moved by (%.3f, %.3f) m and %.2f degrees\n", laid["x_m"].get<double>(),
              laid["y_m"].get<double>(), laid["yaw_deg"].get<double>());
}

/// Maps instead of trajectories.
void add_map_options(CLI::App& command, EvaluateArguments& arguments, CLI::Option& trajectory) {
  CLI::Option* map = command.add_option("--map", arguments.map,
                                        "a map instead of a trajectory: site folder, walls.csv, map_server "
                                        ".yaml, or a living map (.bin)");
  CLI::Option* building =
      command.add_option("--building", arguments.building, "what the building is like: the same kinds");
  const std::map<std::string, MapAlignment> kinds{
      {"none", MapAlignment::None}, {"near", MapAlignment::Near}, {"anywhere", MapAlignment::Anywhere}};
  CLI::Option* align =
      command.add_option("--align", arguments.comparison.alignment,
                         "how the map is laid on the building: none (one frame), near (within "
                         "1 m and 12 degrees of --start; the default), anywhere");
  align->transform(CLI::CheckedTransformer(kinds, CLI::ignore_case));
  CLI::Option* start = command.add_option("--start", arguments.start,
                                          "where the map's frame lies in the building's, \"x y yaw_deg\"");
  CLI::Option* cell =
      command.add_option("--cell", arguments.comparison.cell_m, "side of a compared cell, metres");
  cell->check(within(0.01, 1.0));
  map->check(CLI::ExistingPath)->needs(building)->excludes(&trajectory);
  building->check(CLI::ExistingPath)->needs(map);
  for (CLI::Option* option : {align, start, cell}) option->needs(map);
}

void evaluate(const EvaluateArguments& arguments) {
  const std::vector<StampedPose> estimate = load_tum(arguments.trajectory);
  nlohmann::json score;
  if (!arguments.truth.empty()) {
    std::vector<StampedPose> truth = load_tum(arguments.truth);
    if (!arguments.map_from_reference.empty()) {
      const Transform2<Map, Map> moved = load_map_from_reference(arguments.map_from_reference);
      for (StampedPose& pose : truth) pose.map_from_base = moved * pose.map_from_base;
    }
    score = score_against_truth(estimate, std::move(truth));
  } else {
    score = score_against_relations(estimate, load_relations(arguments.relations));
  }
  write_json(arguments.json_file, score);
  if (arguments.json_file != "-") std::printf("%s\n", score_text(score).c_str());
}

}  // namespace

void add_evaluate(CLI::App& app) {
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command = app.add_subcommand(
      "evaluate", "score a trajectory against a truth or relations, or a map against a building");
  CLI::Option* trajectory = command->add_option("--trajectory", arguments->trajectory, "estimate (TUM)");
  trajectory->check(CLI::ExistingFile);
  CLI::Option* truth = command->add_option("--truth", arguments->truth, "poses taken as truth (TUM)");
  CLI::Option* relations =
      command->add_option("--relations", arguments->relations, "t1 t2 x y z roll pitch yaw a line");
  CLI::Option* moved = command->add_option("--map-from-reference", arguments->map_from_reference,
                                           "YAML: moves the truth into the map frame first");
  truth->check(CLI::ExistingFile)->excludes(relations);
  relations->check(CLI::ExistingFile);
  moved->check(CLI::ExistingFile)->needs(truth);
  command->add_option("--json", arguments->json_file, "figures; - for stdout");
  add_map_options(*command, *arguments, *trajectory);
  command->callback([arguments] {
    if (!arguments->map.empty()) return evaluate_map(*arguments);
    if (arguments->trajectory.empty()) throw CLI::RequiredError("--trajectory, or --map and --building");
    if (arguments->truth.empty() && arguments->relations.empty()) {
      throw CLI::RequiredError("--truth or --relations");
    }
    evaluate(*arguments);
  });
}

}  // namespace madori::app
