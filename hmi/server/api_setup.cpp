#include <fmt/format.h>

#include <cmath>

#include "core/angle.hpp"
#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"

namespace madori::hmi {
namespace {

using nlohmann::json;

json setup_of(ApiContext& context) {
  const LiveState live = context.vehicle.live();
  return {{"steps", context.editor.setup_steps(live.pose)},
          {"drivable", live.drivable},
          {"locked", to_wire(context.vehicle.may_change_site().reason)}};
}

Transform2<Map, Base> pose_from(const json& wire) {
  const Transform2<Map, Base> pose(wire.at("x").get<double>(), wire.at("y").get<double>(),
                                   wire.at("yaw").get<double>());
  constexpr double kFarthest_m = 1e5;
  const bool good = std::isfinite(pose.yaw_rad()) && std::abs(pose.x_m()) < kFarthest_m &&
                    std::abs(pose.y_m()) < kFarthest_m;
  if (!good) throw Error("the pose", "does not lie on the drawing", "choose the place again");
  return pose;
}

/// "the drawing does not fit at x 12.3 m, y 4.5 m, 90 deg: 3 m of wall contradict"
std::string report_of(const json& wire) {
  const auto pose = pose_from(wire);
  return fmt::format(
      "the drawing does not fit at x {:.1f} m, y {:.1f} m, {:.0f} deg: {} m of wall contradict", pose.x_m(),
      pose.y_m(), to_deg(pose.yaw_rad()), whole_number<int>(wire.at("walls")));
}

}  // namespace

void add_setup_routes(Router& router, ApiContext& context) {
  Vehicle& vehicle = context.vehicle;
  router.add("GET", "/api/setup", Role::Viewer, answering([&](const Request&) { return setup_of(context); }),
             Work::Worker);
  router.add("GET", "/api/devices", Role::Viewer,
             answering([&](const Request&) { return list_of(vehicle.found_devices()); }), Work::Worker);
  router.add("POST", "/api/devices/search", Role::Integrator,
             answering([&](const Request&) { return list_of(vehicle.search_devices()); }), Work::Worker);
  router.add("GET", "/api/devices/views", Role::Viewer,
             answering([&](const Request&) { return list_of(vehicle.lidar_views()); }), Work::Worker);
  router.add("GET", "/api/mounting", Role::Viewer,
             answering([&](const Request&) { return to_wire(vehicle.mounting()); }));
  router.add(
      "POST", "/api/mounting", Role::Integrator,
      [&](const Request&) { return answer(vehicle.measure_mounting()); }, Work::Worker);
  router.add("DELETE", "/api/mounting", Role::Operator,
             [&](const Request&) { return answer(vehicle.stop_measuring()); });
  router.add("GET", "/api/locate", Role::Viewer,
             answering([&](const Request&) { return to_wire(vehicle.locate()); }));
  router.add("POST", "/api/locate/search", Role::Operator,
             [&](const Request&) { return answer(vehicle.search_place()); });
  router.add("POST", "/api/vehicle/pose", Role::Operator, guarded([&](const Request& r) {
               const json body = body_of(r);
               const auto pose = pose_from(body);
               const bool insists = body.value("insist", false);
               return answer(insists ? vehicle.insist_on_pose(pose) : vehicle.set_pose(pose));
             }));
  router.add("POST", "/api/vehicle/report", Role::Operator,
             guarded([&](const Request& r) { return answer(vehicle.report(report_of(body_of(r)))); }),
             Work::Worker);
}

}  // namespace madori::hmi
