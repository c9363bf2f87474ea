#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/json_output.hpp"
#include "app/trajectory_score.hpp"

namespace madori::app {
namespace {

struct EvaluateArguments {
  std::string trajectory;
  std::string truth;
  std::string relations;
  std::string map_from_reference;
  std::string json_file;
};

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
  CLI::App* command =
      app.add_subcommand("evaluate", "score a trajectory against a truth or measured relations");
  command->add_option("--trajectory", arguments->trajectory, "estimate (TUM)")
      ->required()
      ->check(CLI::ExistingFile);
  CLI::Option* truth = command->add_option("--truth", arguments->truth, "poses taken as truth (TUM)");
  CLI::Option* relations =
      command->add_option("--relations", arguments->relations, "t1 t2 x y z roll pitch yaw a line");
  CLI::Option* moved = command->add_option("--map-from-reference", arguments->map_from_reference,
                                           "YAML: moves the truth into the map frame first");
  truth->check(CLI::ExistingFile)->excludes(relations);
  relations->check(CLI::ExistingFile);
  moved->check(CLI::ExistingFile)->needs(truth);
  command->add_option("--json", arguments->json_file, "figures; - for stdout");
  command->callback([arguments] {
    if (arguments->truth.empty() && arguments->relations.empty()) {
      throw CLI::RequiredError("--truth or --relations");
    }
    evaluate(*arguments);
  });
}

}  // namespace madori::app
