#pragma once

#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "hmi/server/http.hpp"
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
  auto body = nlohmann::json::parse(request.body, nullptr, false);
  if (!body.is_object()) throw Error("the request", "is no JSON object", "reload the page");
  return body;
}

/// Runs a handler; a request of the wrong shape becomes 400, an edit of an old revision 409.
template <class Work>
[[nodiscard]] Handler guarded(Work work) {
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

/// 200 where the vehicle took a command, 409 with its reason where it did not.
[[nodiscard]] inline Response answer(const Reply& reply) {
  if (reply.accepted) return answer(nlohmann::json::object());
  return Response::error(409, reply.reason.code, reply.reason.text);
}

}  // namespace madori::hmi
