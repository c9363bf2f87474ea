#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"
#include "hmi/server/vehicle_wire.hpp"

namespace madori::hmi {
namespace {

using nlohmann::json;

json wire_of(const MappingView& view) {
  json walls = json::array();
  for (const auto& [a, b] : view.walls) walls.push_back({a.x_m, a.y_m, b.x_m, b.y_m});
  return {{"state", view.state},
          {"driven_m", view.driven_m},
          {"scans", view.scans},
          {"keyframes", view.keyframes},
          {"loops", view.loops},
          {"dropped", view.dropped},
          {"problem", to_wire(view.problem)},
          {"revision", view.revision},
          {"walls", walls},
          {"vehicle", hmi::to_wire(view.vehicle)},
          {"sensors", list_of(view.sensors)}};
}

json mapping_of(const Vehicle& vehicle) {
  json wire = wire_of(vehicle.mapping());
  wire["kinds"] = list_of(vehicle.lidar_kinds());
  return wire;
}

Reply start(Vehicle& vehicle, const json& wanted) {
  return vehicle.start_mapping(vehicle_from(wanted.at("vehicle")), sensors_from(wanted.at("sensors"), {}),
                               wanted.at("anew").get<bool>());
}

Response points_of(const Vehicle& vehicle) {
  const auto frame = vehicle.mapping_points();
  if (!frame) return Response::error(404, "not-mapping", "no map is being made by driving");
  return {200, "application/octet-stream", *frame, {}, {}};
}

Response finish(ApiContext& context) {
  Vehicle& vehicle = context.vehicle;
  const Reply may = vehicle.may_finish_mapping();
  if (!may.accepted) return answer(may);
  const bool started = context.job.start("mapping", [&vehicle](const Job::Progress& progress) {
    const std::size_t walls = vehicle.finish_mapping(progress);
    vehicle.reload_site();
    return Job::Outcome{std::to_string(walls) + " walls", nullptr};
  });
  if (!started) return Response::error(409, "busy", "the server is at other work: try again in a moment");
  return answer(context.job.state());
}

}  // namespace

void add_mapping_routes(Router& router, ApiContext& context) {
  Vehicle& vehicle = context.vehicle;
  SiteEditor& editor = context.editor;
  router.add("GET", "/api/mapping", Role::Viewer,
             answering([&](const Request&) { return mapping_of(vehicle); }), Work::Worker);
  router.add(
      "GET", "/api/mapping/points", Role::Viewer, [&](const Request&) { return points_of(vehicle); },
      Work::Worker);
  router.add("POST", "/api/mapping", Role::Integrator,
             guarded([&](const Request& r) { return answer(start(vehicle, body_of(r))); }), Work::Worker);
  router.add(
      "DELETE", "/api/mapping", Role::Integrator,
      [&](const Request&) { return answer(vehicle.drop_mapping()); }, Work::Worker);
  router.add("POST", "/api/mapping/finish", Role::Integrator,
             guarded([&](const Request&) { return finish(context); }), Work::Worker);
  router.add("GET", "/api/site/routes/driven", Role::Viewer, answering([&](const Request&) {
               return json{{"length_m", planning::length_m(vehicle.driven_way())}};
             }),
             Work::Worker);
  router.add("POST", "/api/site/routes/taught", Role::Integrator, answering([&](const Request& r) {
               return editor.teach_routes(body_of(r), vehicle.driven_way());
             }),
             Work::Worker);
}

}  // namespace madori::hmi
