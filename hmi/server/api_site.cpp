#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"

namespace madori::hmi {
namespace {

using nlohmann::json;

Response csv_file(const std::string& content, const std::string& name) {
  Response response{200, "text/csv; charset=utf-8", content, {}, {}};
  response.headers["Content-Disposition"] = "attachment; filename=\"" + name + "\"";
  return response;
}

void add_routes_routes(Router& router, SiteEditor& editor, Vehicle& vehicle) {
  router.add("GET", "/api/site/routes", Role::Viewer,
             answering([&](const Request&) { return editor.routes(); }), Work::Worker);
  router.add("PUT", "/api/site/routes", Role::Integrator,
             changing(vehicle, [&](const Request& r) { return editor.save_routes(body_of(r)); }),
             Work::Worker);
  router.add("POST", "/api/site/routes/check", Role::Integrator,
             answering([&](const Request& r) { return editor.check_routes(body_of(r)); }), Work::Worker);
  router.add("GET", "/api/site/routes/csv", Role::Viewer,
             answering([&](const Request&) { return editor.routes_csv(); }), Work::Worker);
  router.add("POST", "/api/site/routes/csv", Role::Integrator,
             changing(vehicle, [&](const Request& r) { return editor.import_routes(body_of(r)); }),
             Work::Worker);
  for (const char* name : {"tree.csv", "path.csv"})
    router.add(
        "GET", std::string("/api/site/routes/") + name, Role::Viewer,
        [&editor, name](const Request&) { return csv_file(editor.routes_file(name), name); }, Work::Worker);
}

}  // namespace

void add_site_routes(Router& router, ApiContext& context) {
  SiteEditor& editor = context.editor;
  Vehicle& vehicle = context.vehicle;
  router.add("GET", "/api/site", Role::Viewer, answering([&](const Request&) { return editor.site(); }),
             Work::Worker);
  router.add("GET", "/api/site/walls", Role::Viewer,
             answering([&](const Request&) { return editor.walls(); }), Work::Worker);
  router.add("PUT", "/api/site/walls", Role::Integrator,
             changing(vehicle, [&](const Request& r) { return editor.save_walls(body_of(r)); }),
             Work::Worker);
  router.add("GET", "/api/site/walls/seen", Role::Viewer,
             answering([&](const Request&) { return list_of(vehicle.walls_seen()); }), Work::Worker);
  router.add("PUT", "/api/site/vehicle", Role::Integrator,
             changing(vehicle, [&](const Request& r) { return editor.save_vehicle(body_of(r)); }),
             Work::Worker);
  router.add(
      "GET", "/api/site/drawing.png", Role::Viewer,
      [&](const Request&) {
        return Response{200, "image/png", editor.drawing_png(), {}, {}};
      },
      Work::Worker);
  add_routes_routes(router, editor, vehicle);
}

}  // namespace madori::hmi
