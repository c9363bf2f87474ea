#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/commands/log_arguments.hpp"
#include "app/commands/within.hpp"
#include "app/json_output.hpp"
#include "app/landmarks/corridor_files.hpp"
#include "app/landmarks/landmark_files.hpp"
#include "app/landmarks/log_run.hpp"
#include "app/landmarks/on_drawing.hpp"
#include "app/log_options.hpp"
#include "app/pose_argument.hpp"
#include "core/pose_hypothesis.hpp"
#include "mapping/site/atomic_file.hpp"
#include "sensors/open_log.hpp"

namespace madori::app {
namespace {

namespace lm = localization::landmarks;

struct LandmarkArguments {
  std::string log;
  LogArguments of_log;
  std::vector<std::string> agents;
  std::string simulate;
  std::filesystem::path out;
  std::string site;
  std::string initial;
  std::string json_file;
  bool wheels = false;
  int most = 60;
  unsigned seed = 1;
  int runs = 1;
};

/// Numbers separated by blanks or colons: metres and degrees.
Transform2<Map, Base> pose_of(std::string text, const std::string& option) {
  std::replace(text.begin(), text.end(), ':', ' ');
  return parse_pose(option, text);
}

void write(const std::filesystem::path& out, const char* name, const std::string& text) {
  mapping::write_file_atomically(out / name, text);
}

void simulate(const LandmarkArguments& arguments) {
  const CorridorScenario scenario = load_corridor_scenario(arguments.simulate);
  std::vector<CorridorRun> runs;
  for (int i = 0; i < arguments.runs; ++i)
    runs.push_back(run_corridor(scenario, arguments.seed + static_cast<unsigned>(i)));
  const CorridorSummary all = summarise(runs);
  if (!arguments.out.empty()) {
    std::filesystem::create_directories(arguments.out);
    write(arguments.out, "sightings.csv", corridor_csv(runs.front()));
    write(arguments.out, "figure9.svg", corridor_figure(runs.front()));
  }
  int returns = 0;
  for (const CorridorRun& run : runs) returns += run.returns;
  write_json(arguments.json_file, {{"runs", all.runs},
                                   {"seed", arguments.seed},
                                   {"sightings", all.sightings},
                                   {"matches", all.matches},
                                   {"false_loops", all.false_loops},
                                   {"returns", returns},
                                   {"runs_within_two_sigma", all.runs_within_two_sigma},
                                   {"worst_lap3_m", all.worst_lap3_m},
                                   {"worst_lap3_deg", to_deg(all.worst_lap3_rad)},
                                   {"worst_landmark_m", all.worst_landmark_m},
                                   {"mean_odometry_end_m", all.mean_odometry_end_m},
                                   {"mean_odometry_end_deg", to_deg(all.mean_odometry_end_rad)}});
  std::fprintf(arguments.json_file == "-" ? stderr : stdout,
               "%d runs from seed %u: %d scans at corners, %d matched, %d false loops; every landmark within "
               "2 sigma after the "
               "first loop in %d runs\nlap 3: agent at most %.4f m and %.3f deg off; odometry alone ends "
               "%.3f m and %.1f deg "
               "off in the mean\n",
               all.runs, arguments.seed, all.sightings, all.matches, all.false_loops,
               all.runs_within_two_sigma, all.worst_lap3_m, to_deg(all.worst_lap3_rad),
               all.mean_odometry_end_m, to_deg(all.mean_odometry_end_rad));
}

/// `LOG` or `LOG@x:y:yaw_deg`: a rough start in the frame of the landmarks, as sure as what a person says.
AgentTrack run_agent(const std::string& text, const sensors::LogOptions& options, lm::LandmarkHub& hub,
                     bool match_scans, const Transform2<Map, Map>& map_from_origin) {
  const std::size_t at = text.rfind('@');
  const std::string file = text.substr(0, at);
  std::optional<lm::FullPose> rough;
  if (at != std::string::npos) {
    const auto pose = map_from_origin.inverse() * pose_of(text.substr(at + 1), "--agents");
    constexpr PoseSigma kRough;
    const double m2 = kRough.position_m * kRough.position_m, rad2 = kRough.yaw_rad * kRough.yaw_rad;
    rough = lm::FullPose{{pose.x_m(), pose.y_m(), pose.yaw_rad()}, {lm::Matrix3::diagonal(m2, m2, rad2)}};
  }
  const auto log = sensors::open_log(file, options);
  return AgentTrack(*log, hub, match_scans, rough);
}

void map_log(const LandmarkArguments& arguments) {
  mapping::Site site;
  mapping::Walls walls;
  Transform2<Map, Map> map_from_origin;
  if (!arguments.site.empty()) {
    site = mapping::load_scaled_site(arguments.site);
    walls = mapping::load_walls(std::filesystem::path(arguments.site) / "walls.csv");
    const auto start = pose_of(arguments.initial, "--initial");
    map_from_origin = {start.x_m(), start.y_m(), start.yaw_rad()};
  }
  lm::LandmarkHub hub(arguments.most);
  const sensors::LogOptions options = log_options(site, arguments.of_log);
  std::vector<AgentTrack> tracks{run_agent(arguments.log, options, hub, !arguments.wheels, map_from_origin)};
  for (const std::string& agent : arguments.agents)
    tracks.push_back(run_agent(agent, options, hub, !arguments.wheels, map_from_origin));
  if (!walls.empty()) map_from_origin = landmarks_on_drawing(hub, walls, map_from_origin);
  std::vector<std::vector<StampedPose>> ways;
  std::string trajectory = kTumHead;
  nlohmann::json agents = nlohmann::json::array();
  for (const AgentTrack& track : tracks) {
    ways.push_back(track.trajectory(hub, map_from_origin));
    for (const StampedPose& pose : ways.back()) trajectory += tum_line(pose.stamp, pose.map_from_base);
    agents.push_back({{"driven_m", track.driven_m()},
                      {"sightings", track.sightings().size()},
                      {"recognised", track.recognised()}});
  }
  const auto placed = place_landmarks(hub, map_from_origin);
  std::filesystem::create_directories(arguments.out);
  write(arguments.out, "landmarks.csv", landmarks_csv(placed));
  write(arguments.out, "landmarks.geojson", landmarks_geojson(placed, hub));
  write(arguments.out, "landmarks.dot", landmarks_dot(placed, hub));
  write(arguments.out, "trajectory.tum", trajectory);
  mapping::write_file_atomically(arguments.out / "landmarks.png",
                                 landmarks_picture(placed, hub, ways, walls));
  write_json(arguments.json_file,
             {{"landmarks", hub.map().size()}, {"measurements", hub.measurements()}, {"agents", agents}});
  std::fprintf(arguments.json_file == "-" ? stderr : stdout,
               "%d landmarks, %d measurements between them; %s written\n", hub.map().size(),
               hub.measurements(), arguments.out.c_str());
}

}  // namespace

void add_landmarks(CLI::App& app) {
  auto arguments = std::make_shared<LandmarkArguments>();
  CLI::App* command = app.add_subcommand("landmarks", "map a log by its crossings and turning points alone");
  CLI::Option* log = command->add_option("--log", arguments->log, "log of the first agent, with a 2D lidar")
                         ->check(CLI::ExistingFile);
  command->add_option("--agents", arguments->agents, "logs of further agents: LOG[@x:y:yaw_deg],...")
      ->delimiter(',')
      ->needs(log);
  add_log_arguments(*command, arguments->of_log);
  CLI::Option* scenario =
      command->add_option("--simulate", arguments->simulate, "corridor scenario: the published experiment")
          ->check(CLI::ExistingFile)
          ->excludes(log);
  CLI::Option* out = command->add_option("--out", arguments->out, "folder to write");
  log->needs(out);
  CLI::Option* site =
      command->add_option("--site", arguments->site, "site folder: the landmarks lie in its Map frame")
          ->check(CLI::ExistingDirectory)
          ->needs(log);
  CLI::Option* initial = command->add_option("--initial", arguments->initial,
                                             "\"x y yaw_deg\": start of the log on the drawing");
  site->needs(initial);
  initial->needs(site);
  command->add_flag("--wheels-only", arguments->wheels, "no scan matching between landmarks")->needs(log);
  command->add_option("--most", arguments->most, "landmarks at most")
      ->check(within(1, 63))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "of the first run")->needs(scenario);
  command->add_option("--runs", arguments->runs, "seeds to run")->check(within(1, 100000))->needs(scenario);
  command->add_option("--json", arguments->json_file, "figures; - for stdout");
  command->callback([arguments] {
    expect_json(arguments->json_file, arguments->out);
    if (arguments->log.empty() && arguments->simulate.empty())
      throw CLI::RequiredError("--log or --simulate");
    if (arguments->simulate.empty()) {
      map_log(*arguments);
    } else {
      simulate(*arguments);
    }
  });
}

}  // namespace madori::app
