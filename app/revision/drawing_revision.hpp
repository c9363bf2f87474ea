#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "mapping/drawing/import_drawing.hpp"
#include "mapping/revision/register_walls.hpp"
#include "planning/route_graph/route_check.hpp"

namespace madori::app {

/// What a new revision of a site's drawing changes. Pieces are in the Map frame of the old drawing.
struct DrawingRevision {
  mapping::WallRegistration laid;
  std::vector<Segment2<Map>> gone, added;
  std::vector<Segment2<Map>> walls;              ///< the site's from now on: the old ones, gone and added
  std::vector<planning::RouteFinding> findings;  ///< of the routes, that the old drawing did not have
  std::vector<std::string> stations_lost;        ///< too near to a wall now, or no longer to be reached
};

/// Imports `options.drawing` beside the site and lays it on the site's own walls; nothing of the site
/// changes. `options.site` names the site. Throws Error where the drawing cannot be read, or is no revision
/// of the site's.
[[nodiscard]] DrawingRevision compare_drawing(const mapping::ImportOptions& options,
                                              const mapping::Progress& progress = {});

/// The same, and the new drawing becomes the site's in one step: in the scale of the old one, with routes and
/// georeference carried to where it lies now.
DrawingRevision apply_drawing(const mapping::ImportOptions& options, const mapping::Progress& progress = {});

/// DrawingRevision of docs/reference/command-line.md (`madori diff --json`) and hmi/schema.
[[nodiscard]] nlohmann::json revision_json(const DrawingRevision& revision, bool applied);

}  // namespace madori::app
