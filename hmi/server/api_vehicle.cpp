#include <array>
#include <charconv>
#include <utility>

#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"

namespace madori::hmi {
namespace {

using nlohmann::json;

constexpr std::array<std::pair<const char*, Command>, 6> kCommands{{{"start", Command::Start},
                                                                    {"pause", Command::Pause},
                                                                    {"resume", Command::Resume},
                                                                    {"stop", Command::Stop},
                                                                    {"confirm", Command::Confirm},
                                                                    {"go-on", Command::GoOn}}};

long long id_of(const Request& request) {
  long long id = 0;
  const std::string& text = request.captures.at(0);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (error != std::errc() || end != text.data() + text.size())
    throw Error("order " + text, "has no such number", "reload the page");
  return id;
}

/// The stops of a NewOrder; plain stations where it names no actions.
std::vector<StopView> stops_of(const json& order) {
  std::vector<StopView> stops;
  if (const auto given = order.find("stops"); given != order.end()) {
    for (const auto& stop : *given)
      stops.push_back({whole_number<int>(stop.at("node")), stop.at("action").get<std::string>(),
                       stop.at("wait_s").get<double>()});
    return stops;
  }
  for (const auto& station : order.at("stations")) stops.push_back({whole_number<int>(station), "pass", 0.0});
  return stops;
}

/// A guarded handler whose request has a body.
template <class Do>
Handler taking(Do work) {
  return guarded([work](const Request& request) { return answer(work(body_of(request))); });
}

void add_order_routes(Router& router, Vehicle& vehicle) {
  router.add(
      "GET", "/api/orders", Role::Viewer, [&](const Request&) { return answer(list_of(vehicle.orders())); },
      Work::Worker);
  router.add(
      "GET", "/api/orders/history", Role::Viewer,
      [&](const Request&) { return answer(list_of(vehicle.order_history())); }, Work::Worker);
  router.add("POST", "/api/orders", Role::Operator, taking([&](const json& body) {
               return vehicle.add_order(stops_of(body), whole_number<int>(body.at("repeat")));
             }),
             Work::Worker);
  router.add("PUT", "/api/orders/queue", Role::Operator, taking([&](const json& body) {
               std::vector<long long> ids;
               for (const auto& id : body.at("ids")) ids.push_back(whole_number<long long>(id));
               return vehicle.arrange_orders(ids);
             }),
             Work::Worker);
  router.add(
      "POST", "/api/orders/*/repeat", Role::Operator,
      [&](const Request& request) { return answer(vehicle.repeat_order(id_of(request))); }, Work::Worker);
  router.add(
      "DELETE", "/api/orders/*", Role::Operator,
      [&](const Request& request) { return answer(vehicle.cancel_order(id_of(request))); }, Work::Worker);
}

Response camera_picture(const Vehicle& vehicle) {
  const auto jpeg = vehicle.camera_jpeg();
  if (!jpeg) return Response::error(404, "no-camera", "this vehicle has no camera, or it is silent");
  return {200, "image/jpeg", *jpeg, {}, {}};
}

}  // namespace

void add_vehicle_routes(Router& router, ApiContext& context) {
  Vehicle& vehicle = context.vehicle;
  for (const auto& [name, command] : kCommands)
    router.add("POST", std::string("/api/vehicle/") + name, Role::Operator,
               [&vehicle, c = command](const Request&) { return answer(vehicle.command(c)); });
  // To stand is always allowed: whoever is at the page, logged in or not, may halt the vehicle before it.
  router.add("POST", "/api/vehicle/halt", Role::None,
             [&vehicle](const Request&) { return answer(vehicle.command(Command::Halt)); });
  add_order_routes(router, vehicle);
  router.add("GET", "/api/camera.jpg", Role::Viewer, [&](const Request&) { return camera_picture(vehicle); });
}

}  // namespace madori::hmi
