#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands.hpp"
#include "app/learned/deviations.hpp"
#include "app/learned/learned_drawing.hpp"
#include "app/learned/living_map_file.hpp"
#include "app/learned/map_layers.hpp"
#include "app/plot/reliability_plot.hpp"
#include "core/result.hpp"
#include "hmi/server/site_backup.hpp"
#include "localization/warp/warp_file.hpp"
#include "mapping/georeference/geojson.hpp"
#include "mapping/site/atomic_file.hpp"
#include "planning/route_graph/route_csv.hpp"

namespace madori::app {
namespace {

mapping::GeoContent content_of(const std::filesystem::path& site) {
  mapping::GeoContent content;
  content.walls = mapping::load_walls(site / "walls.csv");
  if (!std::filesystem::exists(site / "routes" / "path.csv")) return content;
  const auto routes = planning::load_routes(site / "routes");
  const auto& nodes = routes.nodes();
  for (const auto& node : nodes) content.nodes.push_back({node.id, node.name, node.position});
  for (const auto& leg : routes.legs())
    content.legs.push_back(
        {nodes[leg.from].id, nodes[leg.to].id, {nodes[leg.from].position, nodes[leg.to].position}});
  return content;
}

struct ExportArguments {
  std::string site;
  std::string geojson;
  std::string reliability;
  std::string deviations;
  std::string backup;
  std::string map_layers;
};

void write_geojson(const ExportArguments& arguments) {
  const std::string text =
      mapping::site_geojson(mapping::load_site(arguments.site), content_of(arguments.site));
  if (arguments.geojson == "-")
    std::fputs(text.c_str(), stdout);
  else
    mapping::write_file_atomically(arguments.geojson, text);
}

/// The picture of what the lidar has seen of the drawn walls so far.
void write_reliability(const ExportArguments& arguments) {
  const std::filesystem::path folder(arguments.site);
  (void)mapping::load_scaled_site(folder);
  const mapping::Walls walls = mapping::load_walls(folder / "walls.csv");
  const LearnedDrawing learned = load_learned_drawing(folder, walls);
  for (const std::string& message : learned.messages) std::fprintf(stderr, "%s\n", message.c_str());
  mapping::write_file_atomically(arguments.reliability, reliability_plot(walls, learned.reliability));
}

/// Where the building is not as drawn: a picture, a table and GeoJSON.
void write_deviations(const ExportArguments& arguments) {
  const std::filesystem::path folder(arguments.site);
  const mapping::Site site = mapping::load_scaled_site(folder);
  const mapping::Walls walls = mapping::load_walls(folder / "walls.csv");
  localization::WarpFit fit;
  const std::string trouble = localization::load_warp(folder / kWarpFile, walls, fit);
  if (!trouble.empty() || fit.walls.empty())
    throw Error((folder / kWarpFile).string(),
                trouble.empty() ? "nothing has been learned of where the walls stand" : trouble,
                "drive, or learn from a log: madori localize DIR --log LOG --learn");
  const std::vector<Deviation> rows = deviations(walls, fit);
  const std::string& stem = arguments.deviations;
  mapping::write_file_atomically(stem + ".png", deviations_plot(walls, rows));
  mapping::write_file_atomically(stem + ".csv", deviations_csv(rows));
  mapping::write_file_atomically(stem + ".geojson", deviations_geojson(site, rows));
}

/// What was seen of the building, drawn or not.
void write_map_layers(const ExportArguments& arguments) {
  const std::filesystem::path folder(arguments.site);
  const mapping::Site site = mapping::load_scaled_site(folder);
  if (!std::filesystem::exists(folder / kLivingMapFile)) (void)load_living_map(folder / kLivingMapFile);
  const LivingMap kept = begin_living_map(folder, mapping::load_walls(folder / "walls.csv"));
  if (!kept.message.empty()) throw Error(kept.message);
  save_map_layers(kept.map, site.georeference, arguments.map_layers);
}

}  // namespace

void add_export(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand("export", "write a site for other programs, and pictures of it");
  command->add_option("site", arguments->site, "the site folder")->required();
  command->add_option("--geojson", arguments->geojson, "GeoJSON, WGS84 (QGIS and others); - for stdout");
  command->add_option("--reliability", arguments->reliability,
                      "picture of what the lidar has seen of the drawn walls (PNG)");
  CLI::Option* deviations = command->add_option(
      "--deviations", arguments->deviations,
      "where the building is not as drawn, wall by wall: STEM.png, STEM.csv and STEM.geojson; "
      "without STEM: deviations in the site folder");
  deviations->expected(0, 1);
  command->add_option("--backup", arguments->backup,
                      "the whole site as one file, with its versions; madori import FILE makes it again");
  command->add_option(
      "--map-layers", arguments->map_layers,
      "folder for what was seen, drawn or not: static, semi_static and free in the format of ROS "
      "map_server");
  command->callback([arguments, deviations] {
    if (deviations->count() > 0 && arguments->deviations.empty())
      arguments->deviations = (std::filesystem::path(arguments->site) / "deviations").string();
    if (arguments->geojson.empty() && arguments->reliability.empty() && arguments->deviations.empty() &&
        arguments->backup.empty() && arguments->map_layers.empty())
      throw CLI::RequiredError("--geojson, --reliability, --deviations, --map-layers or --backup");
    if (!arguments->map_layers.empty()) write_map_layers(*arguments);
    if (!arguments->backup.empty()) hmi::write_backup(arguments->site, arguments->backup);
    if (!arguments->deviations.empty()) write_deviations(*arguments);
    if (!arguments->geojson.empty()) write_geojson(*arguments);
    if (!arguments->reliability.empty()) write_reliability(*arguments);
  });
}

}  // namespace madori::app
