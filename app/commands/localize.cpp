#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "app/commands.hpp"
#include "app/commands/log_arguments.hpp"
#include "app/health_log.hpp"
#include "app/json_output.hpp"
#include "app/learned/calibration_file.hpp"
#include "app/learned/deviations.hpp"
#include "app/learned/kept_memory.hpp"
#include "app/learned/learned_drawing.hpp"
#include "app/learned/living_map_file.hpp"
#include "app/learned/map_layers.hpp"
#include "app/log_options.hpp"
#include "app/log_player.hpp"
#include "app/plot/reliability_plot.hpp"
#include "app/pose_argument.hpp"
#include "app/runner/site_lock.hpp"
#include "app/trajectory_file.hpp"
#include "app/trajectory_plot.hpp"
#include "core/median.hpp"
#include "localization/drawing_learner/drawing_learner.hpp"
#include "localization/wall_reliability/reliability_file.hpp"
#include "localization/warp/warp_file.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site.hpp"

namespace madori::app {
namespace {

struct LocalizeArguments {
  std::string site;
  std::string log;
  LogArguments of_log;
  std::string initial;
  std::string out;
  std::string on_drawing;
  std::string json_file;
  std::string health_file;
  std::string plot;
  std::string walls_plot;
  bool global = false;
  bool memory = false;
  bool learn = false;
  unsigned seed = 1;
};

/// Kept only where the vehicle knew its place at the end.
void keep(localization::Localizer& localizer, const PoseEstimate& last, const std::filesystem::path& folder,
          const mapping::Walls& walls) {
  const LocalizationState state = last.health.state;
  if (state != LocalizationState::Localized && state != LocalizationState::Degraded) {
    std::fprintf(stderr, "%s is left as it was: the drive ended %s\n", (folder / kMemoryFile).c_str(),
                 to_string(state));
    return;
  }
  save_memory(folder, localizer.finished_memory(), walls);
}

/// From the localizer's own memory, whose keyframes the lidar has tied together, where there is one.
localization::SelfCalibration calibrate(const localization::DrawingLearner& learner,
                                        const localization::Localizer& localizer,
                                        const mapping::Walls& walls) {
  const localization::Memory& memory = localizer.memory();
  std::vector<localization::CalibrationKeyframe> keyframes;
  for (std::size_t i = 0; i < memory.size(); ++i)
    keyframes.push_back({memory.poses()[i], localization::surface_pieces(*memory.keyframes()[i].scan)});
  const localization::WallIndex index(walls);
  const auto tied = localization::self_calibrate(index, keyframes, memory.factors());
  const auto alone = learner.calibrate();
  return tied.converged && tied.uniform_sigma() < alone.uniform_sigma() ? tied : alone;
}

/// Where the drawn walls really stand, by the localizer's memory; goes on from what was learned before.
void keep_warp(const std::filesystem::path& folder, const mapping::Walls& walls,
               const localization::Localizer& localizer) {
  localization::WarpFit fit;
  const std::string trouble = localization::load_warp(folder / kWarpFile, walls, fit);
  if (!trouble.empty()) std::fprintf(stderr, "%s\n", trouble.c_str());
  const localization::WallIndex index(walls);
  const localization::MemoryCloud cloud = localization::memory_cloud(localizer.memory());
  fit = fit.walls.empty() ? localization::fit_warp_from_start(index, cloud)
                          : localization::fit_warp(index, cloud, fit.warp);
  localization::save_warp(folder / kWarpFile, fit, walls);
}

void localize(const LocalizeArguments& arguments) {
  const std::filesystem::path folder(arguments.site);
  std::optional<SiteLock> lock;
  if (arguments.learn || arguments.memory) lock.emplace(folder, SiteUse::Change);
  const mapping::Site site = mapping::load_scaled_site(folder);
  const mapping::Walls walls = mapping::load_walls(folder / "walls.csv");
  std::optional<localization::InitialPose> initial;
  if (!arguments.global) initial = localization::InitialPose{parse_pose("--initial", arguments.initial)};
  const LearnedDrawing learned = load_learned_drawing(folder, walls);
  for (const std::string& message : learned.messages) std::fprintf(stderr, "%s\n", message.c_str());
  localization::Localizer localizer(learned.drawing.walls, initial);
  localization::DrawingLearner learner(walls);
  learner.reliability() = learned.reliability;
  LivingMap begun = begin_living_map(folder, walls);
  if (!begun.message.empty()) std::fprintf(stderr, "%s\n", begun.message.c_str());
  localization::MapLearner map_learner(std::move(begun.map));
  KeptMemory kept;
  if (arguments.memory) kept = load_memory(folder, walls);
  if (!kept.message.empty()) std::fprintf(stderr, "%s\n", kept.message.c_str());
  if (kept.memory) localizer.recall(*std::move(kept.memory));
  const auto log = sensors::open_log(arguments.log, log_options(site, arguments.of_log));
  std::string trajectory = kTumHead;
  std::string on_drawing = kTumHead;
  HealthLog health;
  std::vector<PoseEstimate> estimates;
  const PlayedLog played = play_log(
      *log, log_lidars(site), localizer,
      [&](const PoseEstimate& e) {
        trajectory += tum_line(e.stamp, e.map_from_base);
        if (!arguments.on_drawing.empty()) {
          const auto bent = localizer.bent();
          on_drawing += tum_line(e.stamp, bent ? bent->on_drawing(e.map_from_base) : e.map_from_base);
        }
        health.add(e);
        estimates.push_back(e);
      },
      [&](const localization::ScanPoints& points, const Point2<Base>& sensor, const PoseEstimate& e) {
        learner.observe(points, sensor, e);
      },
      arguments.learn ? &map_learner : nullptr);
  require_scans(static_cast<std::size_t>(played.scans), arguments.log);
  std::optional<localization::SelfCalibration> calibration;  // takes a fifth of the time: where asked
  if (arguments.learn || !arguments.json_file.empty()) calibration = calibrate(learner, localizer, walls);
  mapping::write_file_atomically(arguments.out, trajectory);
  if (!arguments.on_drawing.empty()) mapping::write_file_atomically(arguments.on_drawing, on_drawing);
  if (!arguments.health_file.empty()) {
    mapping::write_file_atomically(arguments.health_file, health.csv());
  }
  if (!arguments.plot.empty()) {
    mapping::write_file_atomically(arguments.plot, trajectory_plot(walls, estimates));
  }
  if (!arguments.walls_plot.empty()) {
    mapping::write_file_atomically(arguments.walls_plot, reliability_plot(walls, learner.reliability()));
  }
  const nlohmann::json result = {
      {"scans", played.scans},
      {"odometry_records", played.odometry_records},
      {"keyframes", localizer.memory().size()},
      {"loop_closures", localizer.memory().loops()},
      {"memory_bytes", localizer.memory().bytes()},
      {"memory_recalled", localizer.has_recalled()},
      {"drawing_sigma_m", localizer.evidence().sigma_m},
      {"drawing_inliers", localizer.evidence().inliers},
      {"health", health.json()},
      {"self_calibration", calibration ? to_json(*calibration) : nlohmann::json()},
      {"walls", to_json(learner.reliability())},
      {"scan_ms_median", percentile_of(played.scan_ms, 0.5)},
      {"scan_ms_p99", percentile_of(played.scan_ms, 0.99)},
      {"living_map", arguments.learn ? to_json(map_learner.map()) : nlohmann::json()},
      {"seed", arguments.seed}};
  write_json(arguments.json_file, result);
  // The site last: a drive of which the results could not be written has taught it nothing.
  if (arguments.learn) {
    localization::save_reliability(folder / kReliabilityFile, learner.reliability());
    (void)keep_calibration(folder, walls, *calibration);
    save_living_map(folder, map_learner.map(), walls);
    // A memory that lies in a wrong place would bend the drawing to it.
    if (!estimates.empty() && estimates.back().health.state <= LocalizationState::Degraded)
      keep_warp(folder, walls, localizer);
  }
  if (arguments.memory && !estimates.empty()) keep(localizer, estimates.back(), folder, walls);
  std::fprintf(arguments.json_file == "-" ? stderr : stdout,
               "%d scans, %d odometry records; %s written\n%s\n%s%s", played.scans, played.odometry_records,
               arguments.out.c_str(), health.summary().c_str(),
               calibration ? describe(*calibration).c_str() : "",
               arguments.learn ? "what was learned is kept with the site\n" : "");
}

}  // namespace

void add_localize(CLI::App& app) {
  auto arguments = std::make_shared<LocalizeArguments>();
  CLI::App* command = app.add_subcommand("localize", "where the vehicle of a log was on the site's drawing");
  command->add_option("site", arguments->site, "site folder")->required()->check(CLI::ExistingDirectory);
  command->add_option("--log", arguments->log, "CARMEN .log, ROS 1 .bag, or a 3D lidar's .pcap")
      ->required()
      ->check(CLI::ExistingFile);
  add_wheels(*command, arguments->of_log);
  add_log_arguments(*command, arguments->of_log);
  CLI::Option* initial =
      command->add_option("--initial", arguments->initial, "pose at the start, \"x y yaw_deg\", Map frame");
  CLI::Option* global = command->add_flag("--global", arguments->global, "the start is not known: find it");
  initial->excludes(global);
  command->add_option("--out", arguments->out, "trajectory to write (TUM), a pose a record")->required();
  command->add_option(
      "--on-drawing", arguments->on_drawing,
      "the same poses carried onto the drawing to write (TUM): where a person looks for them");
  command->add_option("--plot", arguments->plot, "picture of the way on the drawing to write (PNG)");
  command->add_option("--health", arguments->health_file,
                      "table of the health at every record to write (CSV)");
  command->add_option("--walls-plot", arguments->walls_plot,
                      "picture of which drawn walls were confirmed, missed or seen displaced (PNG)");
  command->add_flag("--learn", arguments->learn,
                    "keep what was learned of the walls and of the scale with the site");
  command->add_option("--json", arguments->json_file, "figures; - for stdout");
  command->add_flag(
      "--memory", arguments->memory,
      "begin with what earlier drives remembered (DIR/memory.bin), and keep what this one adds");
  command->add_option("--seed", arguments->seed, "accepted for scripts; nothing here is left to chance");
  command->callback([arguments] {
    if (!arguments->global && arguments->initial.empty()) {
      throw CLI::RequiredError("--initial or --global");
    }
    const LocalizeArguments& a = *arguments;
    expect_json(a.json_file);
    expect_outputs({a.out, a.on_drawing, a.health_file, a.plot, a.walls_plot});
    localize(a);
  });
}

}  // namespace madori::app
