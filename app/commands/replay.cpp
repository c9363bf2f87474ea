#include "app/recording/replay.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/cycle/site_config.hpp"
#include "app/json_output.hpp"
#include "app/learned/kept_memory.hpp"
#include "app/pose/localizer_pose.hpp"
#include "core/result.hpp"

namespace madori::app {
namespace {

struct ReplayArguments {
  std::string site;
  std::string run;
  std::string json_file;
};

void run(const ReplayArguments& arguments) {
  const auto loaded = load_for_driving(arguments.site);
  LocalizerPoseOptions options;
  options.memory = load_memory(arguments.run, loaded.walls).memory;
  const auto result = replay(arguments.run, loaded.config,
                             std::make_unique<LocalizerPose>(loaded.walls, loaded.config.lidars, options));
  const double speed = result.worked_s > 0.0 ? result.recorded_s / result.worked_s : 0.0;
  if (arguments.json_file != "-")
    std::printf("%llu steps, %.1f s of driving, replayed %.1f x as fast; %llu commands differ\n",
                static_cast<unsigned long long>(result.steps), result.recorded_s, speed,
                static_cast<unsigned long long>(result.different));
  if (result.recorded_poses && arguments.json_file != "-")
    std::puts(
        "the run's beginning is not among these bags: localization as recorded, everything else computed");
  write_json(arguments.json_file, {{"recorded_poses", result.recorded_poses},
                                   {"steps", result.steps},
                                   {"different", result.different},
                                   {"first_different", result.first_different},
                                   {"recorded_s", result.recorded_s},
                                   {"worked_s", result.worked_s}});
  if (result.different > 0)
    throw Error(arguments.run,
                "step " + std::to_string(result.first_different) + " gave another command than recorded",
                "replay with the site folder and the Madori that recorded it");
}

}  // namespace

void add_replay(CLI::App& app) {
  auto arguments = std::make_shared<ReplayArguments>();
  CLI::App* command = app.add_subcommand("replay", "run the cycle on a recording and compare every command");
  command->add_option("DIR", arguments->site, "site folder, as it was for the run")->required();
  command->add_option("RUN", arguments->run, "folder of a run below DIR/runs, or its only bag")->required();
  command->add_option("--json", arguments->json_file, "the figures as JSON, - for stdout");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace madori::app
