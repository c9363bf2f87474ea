#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands.hpp"
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

}  // namespace

void add_export(CLI::App& app) {
  auto site = std::make_shared<std::string>();
  auto file = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("export", "write a site for other programs");
  command->add_option("site", *site, "the site folder")->required();
  command->add_option("--geojson", *file, "GeoJSON, WGS84 (QGIS and others); - for stdout")->required();
  command->callback([site, file] {
    const std::string text = mapping::site_geojson(mapping::load_site(*site), content_of(*site));
    if (*file == "-")
      std::fputs(text.c_str(), stdout);
    else
      mapping::write_file_atomically(*file, text);
  });
}

}  // namespace madori::app
