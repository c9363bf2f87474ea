#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "app/commands.hpp"
#include "app/demo/demo_run.hpp"
#include "app/import_report.hpp"
#include "app/iso_time.hpp"
#include "app/json_output.hpp"
#include "app/lidars.hpp"
#include "app/panel/reference_lidar.hpp"
#include "core/result.hpp"
#include "mapping/site/site.hpp"
#include "mapping/site/strict_yaml.hpp"
#include "simulation/sensor_suite.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

/// One order each: into the lift, through the automatic door to a goods-in bay, and on to its neighbour.
const std::vector<int> kStations{19, 21, 20};
/// Without a 3D lidar nobody sees whether door and lift are high enough: three stations on this side of them.
const std::vector<int> kNearStations{7, 5, 3};

struct DemoArguments {
  std::string site = "demo";
  std::string data = MADORI_DATA_DIR;
  std::string json_file;
  std::string lidars;
  bool import_only = false;
};

/// The scale as an operator finds it: one dimension line of the drawing, both its ends in pixels.
void scale_by_one_dimension(const fs::path& sample, mapping::ImportOptions& options) {
  auto meta = mapping::StrictYaml::load(sample / "meta.yaml");
  auto scan = meta.section("scan");
  auto known = scan.section("known_length");
  const double metres = known.number("metres", 0.1, 1e5);
  const std::vector<double> px = known.numbers("pixels");
  if (px.size() != 4) throw known.error("pixels", "is not u1, v1, u2, v2");
  options.m_per_px = metres / std::hypot(px[2] - px[0], px[3] - px[1]);
  options.scale_method = "known";
  std::ostringstream input;
  input << px[0] << ',' << px[1] << ',' << px[2] << ',' << px[3] << '=' << metres;
  options.scale_inputs = {input.str()};
}

/// The sample's routes, unless the folder has some already: they may be the operator's own by now.
void copy_routes(const fs::path& sample, const fs::path& site) {
  if (fs::exists(site / "routes")) return;
  fs::copy(sample / "routes_scan", site / "routes");
}

/// The virtual factory's own lidars of those kinds, where it carries them.
std::vector<mapping::SensorRecord> chosen_lidars(const std::string& kinds, const mapping::VehicleRecord& v) {
  const auto carried = simulation::default_sensors(v);
  std::vector<mapping::SensorRecord> chosen;
  std::istringstream words(kinds);
  for (std::string kind; std::getline(words, kind, ',');) {
    (void)sensors::lidar_of(kind, "--lidar " + kinds);
    const auto found = std::ranges::find(carried, kind, &mapping::SensorRecord::type);
    if (found == carried.end()) throw Error("--lidar " + kind, "has no virtual counterpart", "");
    chosen.push_back(*found);
  }
  return chosen;
}

/// The vehicle's lidars: the import knows nothing of vehicles.
void mount_lidars(const fs::path& folder, const std::string& kinds) {
  mapping::Site site = mapping::load_site(folder);
  if (kinds.empty() && !site.sensors.empty()) return;
  site.sensors = chosen_lidars(kinds, site.vehicle);
  if (kinds.empty()) site.sensors = {reference_lidar()};
  (void)lidars_of(site, folder);
  mapping::save_site(folder, site);
}

bool sees_heights(const fs::path& folder) {
  return std::ranges::any_of(lidars_of(mapping::load_site(folder), folder),
                             [](const auto& lidar) { return lidar.kind == LidarKind::Spinning; });
}

mapping::ImportReport import_sample(const DemoArguments& arguments, const fs::path& sample) {
  mapping::ImportOptions options;
  options.drawing = sample / "factory_scan.png";
  options.site = arguments.site;
  options.name = "Sample factory";
  options.date = iso_time_utc();
  options.force = fs::exists(options.site / "site.yaml");
  scale_by_one_dimension(sample, options);
  const mapping::Progress progress = terminal_progress();
  auto report = mapping::import_drawing(options, progress);
  if (progress) progress("done", 1.0);
  copy_routes(sample, options.site);
  mount_lidars(options.site, arguments.lidars);
  return report;
}

void print_deliveries(const DemoResult& result) {
  std::printf("localized after %.1f s, without being told where it stands\n\n", result.localized_after_s);
  std::printf("order  to                     time      way   waited  stop error\n");
  int number = 0;
  for (const DemoDelivery& d : result.deliveries)
    std::printf("%5d  %2d %-16s %6.1f s %6.1f m %6.1f s %9.3f m%s\n", ++number, d.node, d.name.c_str(),
                d.time_s, d.way_m, d.waited_s, d.goal_error_m, d.delivered ? "" : "  NOT DELIVERED");
  std::printf("\ntrue distance from the route: mean %.3f m, most %.3f m; collisions: %zu; %.0f s in all\n",
              result.route_mean_m, result.route_max_m, result.collisions, result.wall_s);
  if (result.confirmed > 0)
    std::printf("a person had to confirm %d fault(s); see events in madori.db\n", result.confirmed);
}

nlohmann::json deliveries_json(const DemoResult& result) {
  nlohmann::json list = nlohmann::json::array();
  for (const DemoDelivery& d : result.deliveries)
    list.push_back({{"node", d.node},
                    {"name", d.name},
                    {"delivered", d.delivered},
                    {"time_s", d.time_s},
                    {"way_m", d.way_m},
                    {"waited_s", d.waited_s},
                    {"goal_error_m", d.goal_error_m}});
  return {{"deliveries", list},
          {"localized_after_s", result.localized_after_s},
          {"route_mean_m", result.route_mean_m},
          {"route_max_m", result.route_max_m},
          {"collisions", result.collisions},
          {"confirmed", result.confirmed},
          {"wall_s", result.wall_s}};
}

void run(const DemoArguments& arguments) {
  expect_json(arguments.json_file, arguments.site);
  const fs::path data(arguments.data);
  const auto report = import_sample(arguments, data / "sample_factory");
  if (arguments.json_file != "-") print_import_summary(report, arguments.site);
  nlohmann::json figures = import_json(report);
  if (!arguments.import_only) {
    spdlog::set_level(spdlog::level::warn);
    const auto result = run_demo({arguments.site, data / "scenarios/demo.yaml",
                                  sees_heights(arguments.site) ? kStations : kNearStations});
    const fs::path picture = fs::path(arguments.site) / "demo.png";
    draw_demo(arguments.site, result, picture);
    if (arguments.json_file != "-") {
      print_deliveries(result);
      std::printf("look at   %s\nrecording %s/runs/demo\n", picture.c_str(), arguments.site.c_str());
    }
    figures["demo"] = deliveries_json(result);
    write_json(arguments.json_file, figures);
    if (!result.all_delivered())
      throw Error(arguments.site, "not every order was delivered",
                  "see events in " + arguments.site + "/madori.db");
    return;
  }
  write_json(arguments.json_file, figures);
}

}  // namespace

void add_demo(CLI::App& app) {
  auto arguments = std::make_shared<DemoArguments>();
  CLI::App* command = app.add_subcommand("demo", "the whole job on the sample factory");
  command->add_option("--site", arguments->site, "the site folder to make")->capture_default_str();
  command->add_option("--data", arguments->data, "folder that holds sample_factory")->capture_default_str();
  command->add_option("--json", arguments->json_file, "write the figures to a file; - for stdout");
  command->add_option("--lidar", arguments->lidars,
                      "what the vehicle sees with, e.g. " + sensors::lidar_rows().front().type +
                          "; several with commas (default: what the site names)");
  command->add_flag("--import-only", arguments->import_only, "make the site, drive nothing");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace madori::app
