#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/commands/log_arguments.hpp"
#include "app/json_output.hpp"
#include "app/log_options.hpp"
#include "app/log_player.hpp"
#include "app/mapped_site.hpp"
#include "app/mapping_run.hpp"
#include "app/runner/site_lock.hpp"
#include "app/trajectory_plot.hpp"
#include "core/median.hpp"
#include "core/result.hpp"
#include "localization/drawing_fit/standing.hpp"
#include "localization/slam/graph_mapper.hpp"
#include "localization/slam/rbpf_mapper.hpp"
#include "localization/slam/slow_lidar_mapper.hpp"
#include "mapping/site/atomic_file.hpp"
#include "sensors/open_log.hpp"

namespace madori::app {
namespace {

struct MapArguments {
  std::string log;
  LogArguments of_log;
  std::filesystem::path out;
  std::string name;
  std::string method = "graph";
  std::uint32_t seed = 1;
  std::string trajectory;
  std::string at_last;
  std::string plot;
  std::string json_file;
  bool force = false;
};

nlohmann::json pose_json(const Transform2<Map, Base>& pose) {
  return {{"x_m", pose.x_m()}, {"y_m", pose.y_m()}, {"yaw_deg", to_deg(pose.yaw_rad())}};
}

std::unique_ptr<localization::Mapper> make_mapper(const std::string& method, std::uint32_t seed) {
  if (method == "slow-lidar") return std::make_unique<localization::SlowLidarMapper>();
  if (method == "rbpf") {
    localization::RbpfOptions options;
    options.seed = seed;
    return std::make_unique<localization::RbpfMapper>(options);
  }
  return std::make_unique<localization::GraphMapper>();
}

std::vector<std::uint8_t> final_plot(const MappingRun& run, const MappedSite& mapped) {
  std::vector<PoseEstimate> way;
  for (const localization::MomentPose& pose : run.at_last)
    way.push_back({pose.stamp,
                   mapped.map_from_memory * pose.map_from_base,
                   Eigen::Matrix3d::Zero(),
                   {LocalizationState::Localized, {}}});
  return trajectory_plot(mapped.walls, way);
}

void map_log(const MapArguments& arguments) {
  expect_json(arguments.json_file, arguments.out);
  expect_outputs({arguments.trajectory, arguments.at_last, arguments.plot}, arguments.out);
  const bool replaces = std::filesystem::exists(arguments.out / "site.yaml");
  if (replaces && !arguments.force) {
    throw Error(arguments.out.string(), "is a site already",
                "choose another --out, or give --force to replace it");
  }
  const SiteLock lock(arguments.out, SiteUse::Change);
  const std::unique_ptr<localization::Mapper> mapper = make_mapper(arguments.method, arguments.seed);
  const mapping::Site vehicle_of = replaces ? mapping::load_site(arguments.out) : mapping::Site{};
  const auto log = sensors::open_log(arguments.log, log_options(vehicle_of, arguments.of_log));
  const MappingRun run = run_mapper(*log, log_lidars(vehicle_of), *mapper);
  const localization::Memory& memory = run.map.memory;
  const MappedSite mapped = map_site(localization::standing_cloud(memory), arguments.log);
  const std::string name =
      arguments.name.empty() ? std::filesystem::path(arguments.log).stem().string() : arguments.name;
  save_mapped_site(mapped, arguments.out, {name, arguments.log});
  if (!arguments.trajectory.empty())
    mapping::write_file_atomically(arguments.trajectory, tum_text(run.causal, mapped.map_from_memory));
  if (!arguments.at_last.empty())
    mapping::write_file_atomically(arguments.at_last, tum_text(run.at_last, mapped.map_from_memory));
  if (!arguments.plot.empty()) mapping::write_file_atomically(arguments.plot, final_plot(run, mapped));
  const Transform2<Map, Base> start = mapped.map_from_memory * memory.poses().front();
  double length_m = 0.0;
  for (const mapping::Wall& wall : mapped.walls) length_m += wall.segment.length_m();
  write_json(arguments.json_file, {{"method", arguments.method},
                                   {"scans", run.played.scans},
                                   {"keyframes", memory.size()},
                                   {"loop_closures", memory.loops()},
                                   {"walls", mapped.walls.size()},
                                   {"wall_length_m", length_m},
                                   {"start", pose_json(start)},
                                   {"lost_scans", run.map.lost_scans},
                                   {"carried", run.map.carried.size()},
                                   {"scan_ms_median", percentile_of(run.played.scan_ms, 0.5)},
                                   {"scan_ms_p99", percentile_of(run.played.scan_ms, 0.99)},
                                   {"finish_s", run.finish_s}});
  std::FILE* out = arguments.json_file == "-" ? stderr : stdout;
  if (run.map.lost_scans > 0)
    std::fprintf(out, "%d scans lie nowhere in the map: drive the places again that they show\n",
                 run.map.lost_scans);
  std::fprintf(out,
               "%d scans, %d loops closed: %zu walls, %.0f m; the log starts at \"%.3f %.3f %.2f\" (for "
               "localize --initial)\n%s written; look at import.png there\n",
               run.played.scans, memory.loops(), mapped.walls.size(), length_m, start.x_m(), start.y_m(),
               to_deg(start.yaw_rad()), arguments.out.c_str());
}

}  // namespace

void add_map(CLI::App& app) {
  auto arguments = std::make_shared<MapArguments>();
  CLI::App* command = app.add_subcommand("map", "build a site from a log, where there is no drawing");
  command->add_option("--log", arguments->log, "CARMEN .log, ROS 1 .bag, or a 3D lidar's .pcap")
      ->required()
      ->check(CLI::ExistingFile);
  add_wheels(*command, arguments->of_log);
  add_log_arguments(*command, arguments->of_log);
  command->add_option("--out", arguments->out, "site folder to write")->required();
  command->add_option("--name", arguments->name, "of the site; the log's where not given");
  command->add_option("--method", arguments->method, "how: graph, slow-lidar, or rbpf")
      ->check(CLI::IsMember({"graph", "slow-lidar", "rbpf"}))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "of the particles; for --method rbpf")
      ->capture_default_str();
  command->add_flag("--force", arguments->force,
                    "replace the map of an existing site; vehicle and lidars stay, routes go");
  command->add_option("--trajectory", arguments->trajectory, "TUM file of the poses as they were known");
  command->add_option("--final", arguments->at_last, "TUM file of the poses after all loops");
  command->add_option("--plot", arguments->plot, "PNG of the walls and the final way");
  command->add_option("--json", arguments->json_file, "figures; - for stdout");
  command->callback([arguments] { map_log(*arguments); });
}

}  // namespace madori::app
