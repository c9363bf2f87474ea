#include "hmi/server/site_files.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "mapping/site/site.hpp"
#include "mapping/wall_map/wall.hpp"
#include "planning/route_graph/route_check.hpp"
#include "planning/route_graph/vehicle_fit.hpp"

namespace madori::hmi {

bool has_site(const std::filesystem::path& folder) {
  std::error_code missing;
  return std::filesystem::exists(folder / "site.yaml", missing);
}

std::vector<Segment2<Map>> drawn_walls(const std::filesystem::path& folder) {
  std::vector<Segment2<Map>> walls;
  if (!has_site(folder)) return walls;
  for (const auto& wall : mapping::load_walls(folder / "walls.csv")) walls.push_back(wall.segment);
  return walls;
}

std::vector<planning::RouteFinding> findings_of(const std::filesystem::path& folder,
                                                const planning::RouteGraph& graph) {
  planning::RouteCheckOptions options;
  if (has_site(folder)) options.vehicle = planning::outline_of(mapping::load_site(folder).vehicle);
  return planning::check_routes(graph, drawn_walls(folder), options);
}

std::string attribution_of(const std::filesystem::path& tiles) {
  std::ifstream stream(tiles / "source.json");
  const auto source = nlohmann::json::parse(stream, nullptr, false);
  return source.is_object() ? source.value("attribution", "") : "";
}

}  // namespace madori::hmi
