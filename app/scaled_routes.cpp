#include "app/scaled_routes.hpp"

#include <filesystem>

#include "planning/route_graph/route_csv.hpp"

namespace madori::app {

planning::RouteGraph scaled(const planning::RouteGraph& routes, double factor) {
  auto nodes = routes.nodes();
  for (auto& node : nodes) node.position = {node.position.x_m * factor, node.position.y_m * factor};
  return {std::move(nodes), routes.legs()};
}

void stage_scaled_routes(const std::filesystem::path& site, mapping::SiteTransaction& change, double factor) {
  if (!std::filesystem::exists(site / "routes" / "path.csv")) return;
  change.write("routes/path.csv", planning::path_csv(scaled(planning::load_routes(site / "routes"), factor)));
}

}  // namespace madori::app
