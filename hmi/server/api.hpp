#pragma once

#include <functional>
#include <string>

#include "hmi/server/access.hpp"
#include "hmi/server/drawing_preview.hpp"
#include "hmi/server/http.hpp"
#include "hmi/server/job.hpp"
#include "hmi/server/replay.hpp"
#include "hmi/server/site_editor.hpp"
#include "hmi/server/vehicle.hpp"
#include "mapping/georeference/apply_scale.hpp"

namespace madori::hmi {

/// What the handlers work on; all of it must outlive the router.
struct ApiContext {
  Access& access;
  SiteEditor& editor;
  Vehicle& vehicle;
  Job& job;
  Replay& replay;
  std::function<std::string()> iso_time;  ///< for what is recorded with a date
  mapping::StageScaled stage_scaled;      ///< what else of the site changes with its scale: the routes
  MakeDrawingPreview preview_drawing;     ///< a new revision of the site's drawing, before it is taken over
  std::function<std::string()> metrics = nullptr;  ///< of the program, in Prometheus' text format
};

/// Every address below /api but the live socket (docs/reference/panel.md).
[[nodiscard]] Router make_router(ApiContext& context);

void add_session_routes(Router& router, ApiContext& context);
void add_site_routes(Router& router, ApiContext& context);
void add_import_routes(Router& router, ApiContext& context);
void add_mapping_routes(Router& router, ApiContext& context);
void add_preview_routes(Router& router, ApiContext& context);
void add_tile_routes(Router& router, ApiContext& context);
void add_setup_routes(Router& router, ApiContext& context);
void add_scale_routes(Router& router, ApiContext& context);
void add_braking_routes(Router& router, ApiContext& context);
void add_vehicle_routes(Router& router, ApiContext& context);
void add_history_routes(Router& router, ApiContext& context);
void add_backup_routes(Router& router, ApiContext& context);
void add_version_routes(Router& router, ApiContext& context);
void add_day_routes(Router& router, ApiContext& context);
void add_doubt_routes(Router& router, ApiContext& context);

}  // namespace madori::hmi
