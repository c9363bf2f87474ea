#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"
#include "hmi/server/import_request.hpp"

namespace madori::hmi {
namespace {

using nlohmann::json;

json to_wire(const mapping::ImportReport& report) {
  return {{"walls", report.walls.size()},
          {"wall_length", report.wall_length()},
          {"rejected", report.found.rejected.size()},
          {"skew_deg", report.found.skew_deg},
          {"notes", report.notes}};
}

void require_change(const Vehicle& vehicle) {
  const Reply may = vehicle.may_change_site();
  if (!may.accepted) throw Job::Failed(may.reason.code, may.reason.text);
}

Response start_import(ApiContext& context, const Request& request) {
  const Reply may = context.vehicle.may_change_site();
  if (!may.accepted) return answer(may);
  const UploadedDrawing drawing = uploaded_drawing(context, request);
  const bool started = context.job.start("import", [drawing, &context](const Job::Progress& progress) {
    const auto standing = [&](const std::string& stage, double share) {
      progress(stage, share);
      if (stage == "commit") require_change(context.vehicle);  // it may have driven off meanwhile
    };
    const auto report =
        drawing.read([&](const auto& options) { return mapping::import_drawing(options, standing); });
    context.vehicle.reload_site();
    return Job::Outcome{std::to_string(report.walls.size()) + " walls", to_wire(report)};
  });
  if (!started) return Response::error(409, "busy", "another drawing is being imported");
  return answer(context.job.state());
}

}  // namespace

void add_import_routes(Router& router, ApiContext& context) {
  router.add("POST", "/api/site/drawing", Role::Integrator,
             guarded([&](const Request& request) { return start_import(context, request); }), Work::Upload);
  router.add("GET", "/api/job", Role::Viewer, [&](const Request&) { return answer(context.job.state()); });
  router.add("DELETE", "/api/job", Role::Integrator, [&](const Request&) {
    context.job.cancel();
    return answer(json::object());
  });
}

}  // namespace madori::hmi
