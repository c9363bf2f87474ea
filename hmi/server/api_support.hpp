#pragma once

#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "hmi/server/http.hpp"
#include "hmi/server/json_text.hpp"
#include "hmi/server/site_editor.hpp"
#include "hmi/server/vehicle.hpp"
#include "hmi/server/wire.hpp"

/// What the api_*.cpp share.
namespace madori::hmi {

[[nodiscard]] inline Response answer(const nlohmann::json& value) {
  return Response::json(dump(value));
}

/// The body as a JSON object; throws Error on anything else.
[[nodiscard]] inline nlohmann::json body_of(const Request& request) {
  auto body = parse_json(request.body);
  if (!body.is_object()) throw Error("the request", "is no JSON object", "reload the page");
  return body;
}

/// Runs a handler; a request of the wrong shape becomes 400, an edit of an old revision 409.
template <class Do>
[[nodiscard]] Handler guarded(Do work) {
  return [work](const Request& request) -> Response {
    try {
      return work(request);
    } catch (const Conflict& conflict) {
      return Response::error(409, "conflict", conflict.what());
    } catch (const nlohmann::json::exception&) {
      return Response::error(400, "bad-request", "the request has not the agreed form");
    }
  };
}

/// A guarded handler of JSON values.
template <class Do>
[[nodiscard]] Handler answering(Do work) {
  return guarded([work](const Request& request) { return answer(work(request)); });
}

/// A list of wire types.
template <class Values>
[[nodiscard]] nlohmann::json list_of(const Values& values) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& value : values) list.push_back(to_wire(value));
  return list;
}

/// A query parameter; empty where there is none.
[[nodiscard]] inline std::string query_of(const Request& request, const std::string& name) {
  const auto found = request.query.find(name);
  return found == request.query.end() ? std::string() : found->second;
}

/// 200 where the vehicle took a command, 409 with its reason where it did not.
[[nodiscard]] inline Response answer(const Reply& reply) {
  if (reply.accepted) return answer(nlohmann::json::object());
  return Response::json(dump({{"error", to_wire(reply.reason)}}), 409);
}

/// As `answering`, for what changes the site: refused while the vehicle drives, and taken over by it after.
template <class Do>
[[nodiscard]] Handler changing(Vehicle& vehicle, Do work) {
  return guarded([&vehicle, work](const Request& request) {
    const Reply may = vehicle.may_change_site();
    if (!may.accepted) return answer(may);
    Response done = answer(work(request));
    vehicle.reload_site();
    return done;
  });
}

}  // namespace madori::hmi
