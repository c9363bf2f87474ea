#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"

namespace madori::hmi {
namespace {

using nlohmann::json;

constexpr std::array<std::pair<const char*, Command>, 5> kCommands{{{"start", Command::Start},
                                                                    {"pause", Command::Pause},
                                                                    {"resume", Command::Resume},
                                                                    {"stop", Command::Stop},
                                                                    {"confirm", Command::Confirm}}};

template <class Values>
json list_of(const Values& values) {
  json list = json::array();
  for (const auto& value : values) list.push_back(to_wire(value));
  return list;
}

long long id_of(const Request& request) {
  long long id = 0;
  const std::string& text = request.captures.at(0);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (error != std::errc() || end != text.data() + text.size())
    throw Error("order " + text, "has no such number", "reload the page");
  return id;
}

/// A guarded handler whose request has a body.
template <class Work>
Handler taking(Work work) {
  return guarded([work](const Request& request) { return answer(work(body_of(request), request)); });
}

}  // namespace

void add_vehicle_routes(Router& router, ApiContext& context) {
  Vehicle& vehicle = context.vehicle;
  for (const auto& [name, command] : kCommands)
    router.add("POST", std::string("/api/vehicle/") + name, Role::Operator,
               [&vehicle, c = command](const Request&) { return answer(vehicle.command(c)); });

  router.add("GET", "/api/orders", Role::Viewer,
             [&](const Request&) { return answer(list_of(vehicle.orders())); });
  router.add("POST", "/api/orders", Role::Operator, taking([&](const json& body, const Request&) {
               return vehicle.add_order(body.at("stations").get<std::vector<int>>(),
                                        body.at("repeat").get<int>());
             }));
  router.add("DELETE", "/api/orders/*", Role::Operator,
             [&](const Request& request) { return answer(vehicle.cancel_order(id_of(request))); });
  router.add("GET", "/api/events", Role::Viewer,
             [&](const Request&) { return answer(list_of(vehicle.events(200))); });
  router.add("GET", "/api/statistics", Role::Viewer,
             [&](const Request&) { return answer(to_wire(vehicle.statistics())); });
}

}  // namespace madori::hmi
