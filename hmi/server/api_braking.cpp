#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"

namespace madori::hmi {
namespace {

using nlohmann::json;

json braking_of(const BrakingView& view) {
  json stops = json::array();
  for (const auto& stop : view.stops)
    stops.push_back({{"loaded", stop.loaded},
                     {"speed_mps", stop.speed_mps},
                     {"deceleration_mps2", stop.deceleration_mps2},
                     {"latency_s", stop.latency_s},
                     {"way_m", stop.way_m}});
  json wire{
      {"running", view.running}, {"stops_now", view.stops_now},      {"stops_wanted", view.stops_wanted},
      {"way_m", view.way_m},     {"trouble", to_wire(view.trouble)}, {"stops", stops},
      {"verdict", nullptr}};
  if (const auto& v = view.verdict)
    wire["verdict"] = {{"deceleration_mps2", v->deceleration_mps2},
                       {"reaction_s", v->reaction_s},
                       {"needs_m", v->needs_m},
                       {"sees_m", v->sees_m},
                       {"allowed_mps", v->allowed_mps}};
  return wire;
}

}  // namespace

void add_braking_routes(Router& router, ApiContext& context) {
  Vehicle& vehicle = context.vehicle;
  router.add("GET", "/api/vehicle/braking", Role::Viewer,
             answering([&](const Request&) { return braking_of(vehicle.braking()); }));
  router.add("POST", "/api/vehicle/braking", Role::Operator, guarded([&](const Request& r) {
               return answer(vehicle.start_braking_test(body_of(r).at("loaded").get<bool>()));
             }));
}

}  // namespace madori::hmi
