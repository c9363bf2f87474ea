#pragma once

#include "mapping/site/site_transaction.hpp"
#include "planning/route_graph/route_graph.hpp"

namespace madori::app {

/// The same routes with every position multiplied by `factor`.
[[nodiscard]] planning::RouteGraph scaled(const planning::RouteGraph& routes, double factor);

/// Stages routes/path.csv of `site` with its positions multiplied; nothing where the site has no routes.
/// Throws Error when they cannot be read.
void stage_scaled_routes(const std::filesystem::path& site, mapping::SiteTransaction& change, double factor);

}  // namespace madori::app
