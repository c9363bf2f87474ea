#include "hmi/server/gate.hpp"

#include "hmi/server/origin.hpp"

namespace madori::hmi {
namespace {

using Way = Gate::Passage::Way;

Gate::Passage refused(int status, const char* code, const char* text) {
  return {Way::Refused, Response::error(status, code, text), {}};
}

Gate::Passage refused(int status) {
  switch (status) {
    case 401:
      return refused(401, "no-session", "enter a PIN first");
    case 403:
      return refused(403, "not-allowed", "this needs an operator's or integrator's PIN");
    case 405:
      return refused(405, "wrong-method", "this address does not take that method");
    default:
      return refused(404, "not-found", "there is no such address");
  }
}

}  // namespace

Gate::Passage Gate::pass(std::string_view target, Request& request) const {
  if (!parse_target(target, request)) return refused(400, "bad-target", "the address is malformed");
  const std::string host = request.header("host");
  if (!host_allowed(host, loopback_only_)) return refused(421, "wrong-host", "this server has another name");
  const bool changes = request.method != "GET" && request.method != "HEAD";
  const bool live = request.path == "/api/live";
  if (!origin_allowed(request.header("origin"), host, changes || live))
    return refused(403, "wrong-origin", "the request comes from another page");
  if (live) {
    if (request.role < Role::Viewer) return refused(401);
    return {Way::Live, {}, {}};
  }
  if (!request.path.starts_with("/api/")) {
    if (changes) return refused(405, "not-allowed", "this page can only be read");
    return {Way::Page, {}, {}};
  }
  Router::Match match = router_.match(request);
  if (match.refusal != 0) return refused(match.refusal);
  return {Way::Api, {}, match};
}

}  // namespace madori::hmi
