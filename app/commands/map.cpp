#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/json_output.hpp"
#include "app/log_options.hpp"
#include "app/log_player.hpp"
#include "app/mapped_site.hpp"
#include "core/result.hpp"

namespace madori::app {
namespace {

struct MapArguments {
  std::string log;
  std::string wheels;
  std::filesystem::path out;
  std::string name;
  std::string json_file;
  bool force = false;
};

nlohmann::json pose_json(const Transform2<Map, Base>& pose) {
  return {{"x_m", pose.x_m()}, {"y_m", pose.y_m()}, {"yaw_deg", to_deg(pose.yaw_rad())}};
}

void map_log(const MapArguments& arguments) {
  if (!arguments.force && std::filesystem::exists(arguments.out / "site.yaml")) {
    throw Error(arguments.out.string(), "is a site already",
                "choose another --out, or give --force to replace it");
  }
  localization::Localizer localizer({}, localization::InitialPose{});
  const auto log = sensors::open_log(arguments.log, log_options({}, arguments.wheels));
  const PlayedLog played = play_log(*log, log_lidar({}), localizer, [](const PoseEstimate&) {});
  const localization::Memory memory = localizer.finished_memory();
  const MappedSite mapped = map_site(localization::memory_cloud(memory), arguments.log);
  const std::string name =
      arguments.name.empty() ? std::filesystem::path(arguments.log).stem().string() : arguments.name;
  save_mapped_site(mapped, arguments.out, name, arguments.log);
  const Transform2<Map, Base> start = mapped.map_from_memory * memory.poses().front();
  double length_m = 0.0;
  for (const mapping::Wall& wall : mapped.walls) length_m += wall.segment.length_m();
  write_json(arguments.json_file, {{"scans", played.scans},
                                   {"keyframes", memory.size()},
                                   {"loop_closures", memory.loops()},
                                   {"walls", mapped.walls.size()},
                                   {"wall_length_m", length_m},
                                   {"start", pose_json(start)}});
  std::fprintf(arguments.json_file == "-" ? stderr : stdout,
               "%d scans, %d loops closed: %zu walls, %.0f m; the log starts at \"%.3f %.3f %.2f\" (for "
               "localize --initial)\n%s written; look at import.png there\n",
               played.scans, memory.loops(), mapped.walls.size(), length_m, start.x_m(), start.y_m(),
               to_deg(start.yaw_rad()), arguments.out.c_str());
}

}  // namespace

void add_map(CLI::App& app) {
  auto arguments = std::make_shared<MapArguments>();
  CLI::App* command = app.add_subcommand("map", "build a site from a log, where there is no drawing");
  command->add_option("--log", arguments->log, "CARMEN .log, ROS 1 .bag, or a 3D lidar's .pcap")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--wheels", arguments->wheels, "time_s,left_rad,right_rad; for a .pcap")
      ->check(CLI::ExistingFile);
  command->add_option("--out", arguments->out, "site folder to write")->required();
  command->add_option("--name", arguments->name, "of the site; the log's where not given");
  command->add_flag("--force", arguments->force, "replace an existing site's walls and drawing");
  command->add_option("--json", arguments->json_file, "figures; - for stdout");
  command->callback([arguments] { map_log(*arguments); });
}

}  // namespace madori::app
