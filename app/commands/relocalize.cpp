#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/commands/log_arguments.hpp"
#include "app/json_output.hpp"
#include "app/log_options.hpp"
#include "app/log_player.hpp"
#include "app/trajectory_file.hpp"
#include "core/median.hpp"
#include "core/result.hpp"
#include "localization/global/global_localizer.hpp"
#include "localization/wall_extraction/wall_extraction.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site.hpp"
#include "sensors/open_log.hpp"

namespace madori::app {
namespace {

namespace loc = localization;

struct RelocalizeArguments {
  std::string site;
  std::string log;
  LogArguments of_log;
  std::string out;
  std::string json_file;
  bool best_guess = false;
};

/// What was found, over all scans of the log.
struct Tally {
  std::string trajectory =
      "# timestamp x y z qx qy qz qw, Map frame; scans without a certain place as comments\n";
  nlohmann::json scans = nlohmann::json::array();
  int count[3] = {0, 0, 0};  ///< by GlobalState
  std::vector<double> ms;
};

/// The views of the site's places: as saved, else computed and saved for the next time.
loc::PlaceIndex place_index(const std::filesystem::path& site, const mapping::Walls& walls) {
  const auto file = site / "places.bin";
  if (auto saved = loc::PlaceIndex::load(file, walls)) return std::move(*saved);
  loc::PlaceIndex index(walls, mapping::DistanceField(walls));
  try {
    index.save(file, walls);
  } catch (const Error& e) {  // a read-only site: the next start computes them again
    std::fprintf(stderr, "madori: %s\n", e.what());
  }
  return index;
}

/// The points of a record that may be walls; nothing for odometry.
std::optional<loc::ScanPoints> wall_points(const sensors::LogRecord& record, const LogLidars& lidars) {
  if (const auto* scan = std::get_if<sensors::ScanRecord>(&record))
    return loc::extract_walls(points_of(*scan, loc::kWallNearestM));
  if (const auto* cloud = std::get_if<sensors::CloudRecord>(&record))
    return loc::extract_walls(sensors::cloud_in_base(*cloud), lidars.at(cloud->cloud.lidar));
  return std::nullopt;
}

nlohmann::json hypothesis_json(const loc::Hypothesis& h) {
  const auto& pose = h.fit.map_from_base;
  return {{"x_m", pose.x_m()},
          {"y_m", pose.y_m()},
          {"yaw_deg", to_deg(pose.yaw_rad())},
          {"probability", h.probability},
          {"e_psr_m", h.fit.e_psr_m},
          {"inlier_fraction", h.fit.inlier_fraction},
          {"log_likelihood", h.log_likelihood},
          {"through_walls", h.through_walls}};
}

void add_scan(Tally& tally, Stamp stamp, const loc::GlobalAnswer& answer, bool best_guess) {
  ++tally.count[static_cast<int>(answer.state)];
  nlohmann::json entry = {{"time_s", to_seconds(stamp)}, {"state", to_string(answer.state)}};
  entry["reason"] = answer.reason;
  entry["hypotheses"] = nlohmann::json::array();
  for (std::size_t i = 0; i < std::min<std::size_t>(answer.hypotheses.size(), 5); ++i)
    entry["hypotheses"].push_back(hypothesis_json(answer.hypotheses[i]));
  tally.scans.push_back(std::move(entry));
  const bool certain = answer.state == loc::GlobalState::Found;
  if (!certain)
    tally.trajectory += "# " + std::to_string(to_seconds(stamp)) + " " + to_string(answer.state) + ": " +
                        answer.reason + "\n";
  if (certain || (best_guess && !answer.hypotheses.empty()))
    tally.trajectory += tum_line(stamp, answer.hypotheses.front().fit.map_from_base);
}

void relocalize(const RelocalizeArguments& arguments) {
  expect_outputs({arguments.out});
  expect_json(arguments.json_file);
  const std::filesystem::path folder(arguments.site);
  const mapping::Site site = mapping::load_scaled_site(folder);
  const mapping::Walls walls = mapping::load_walls(folder / "walls.csv");
  const loc::GlobalLocalizer global(walls, place_index(folder, walls));
  const auto log = sensors::open_log(arguments.log, log_options(site, arguments.of_log));
  const LogLidars lidars = log_lidars(site);
  Tally tally;
  while (const auto record = log->next()) {
    const auto started = std::chrono::steady_clock::now();
    const auto points = wall_points(*record, lidars);
    if (!points) continue;
    const loc::GlobalAnswer answer = global.locate(*points);
    tally.ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - started).count());
    add_scan(tally, stamp_of(*record), answer, arguments.best_guess);
  }
  require_scans(tally.ms.size(), arguments.log);
  mapping::write_file_atomically(arguments.out, tally.trajectory);
  const double median = tally.ms.empty() ? 0.0 : median_of(tally.ms);
  const auto [found, ambiguous, nowhere] = tally.count;
  write_json(arguments.json_file, {{"found", found},
                                   {"ambiguous", ambiguous},
                                   {"nowhere", nowhere},
                                   {"ms_median", median},
                                   {"scans", tally.scans}});
  std::fprintf(arguments.json_file == "-" ? stderr : stdout,
               "%d scans found, %d ambiguous, %d nowhere; %.1f ms each; %s written\n", found, ambiguous,
               nowhere, median, arguments.out.c_str());
}

}  // namespace

void add_relocalize(CLI::App& app) {
  auto arguments = std::make_shared<RelocalizeArguments>();
  CLI::App* command = app.add_subcommand(
      "relocalize", "find each scan of a log on the drawing by itself: no odometry, no history");
  command->add_option("site", arguments->site, "site folder")->required()->check(CLI::ExistingDirectory);
  command->add_option("--log", arguments->log, "CARMEN log, .bag or .pcap")
      ->required()
      ->check(CLI::ExistingFile);
  add_wheels(*command, arguments->of_log);
  add_log_arguments(*command, arguments->of_log);
  command->add_option("--out", arguments->out, "poses to write (TUM), one a scan that was found")->required();
  command->add_option("--json", arguments->json_file, "state and hypotheses of every scan; - for stdout");
  command->add_flag("--best-guess", arguments->best_guess,
                    "also write the likeliest pose of uncertain scans");
  command->callback([arguments] { relocalize(*arguments); });
}

}  // namespace madori::app
