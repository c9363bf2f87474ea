#include "hmi/server/api.hpp"

#include <nlohmann/json.hpp>

#include "hmi/server/api_support.hpp"

namespace madori::hmi {

Router make_router(ApiContext& context) {
  Router router;
  add_session_routes(router, context);
  add_site_routes(router, context);
  add_import_routes(router, context);
  add_preview_routes(router, context);
  add_mapping_routes(router, context);
  add_backup_routes(router, context);
  add_scale_routes(router, context);
  add_tile_routes(router, context);
  add_setup_routes(router, context);
  add_braking_routes(router, context);
  add_vehicle_routes(router, context);
  add_history_routes(router, context);
  add_version_routes(router, context);
  add_day_routes(router, context);
  add_doubt_routes(router, context);
  return router;
}

void add_session_routes(Router& router, ApiContext& context) {
  router.add("GET", "/api/session", Role::None, [&context](const Request& request) {
    return answer({{"role", to_string(request.role)}, {"needs_pin", context.access.needs_pin()}});
  });
  router.add("POST", "/api/session", Role::None, guarded([&context](const Request& request) {
               const auto login = context.access.login(body_of(request).at("pin").get<std::string>(),
                                                       request.header("x-peer"));
               if (login.too_many_tries)
                 return Response::error(429, "too-many-tries", "too many wrong PINs: wait a minute");
               if (!login.token) return Response::error(401, "wrong-pin", "this PIN is not known");
               Response response = answer({{"role", to_string(login.role)}, {"needs_pin", true}});
               response.headers["Set-Cookie"] =
                   "madori_session=" + *login.token + "; HttpOnly; SameSite=Strict; Path=/";
               return response;
             }),
             Work::Worker);
  router.add("DELETE", "/api/session", Role::None, [&context](const Request& request) {
    context.access.logout(request.cookie("madori_session"));
    return answer(nlohmann::json::object());
  });
}

}  // namespace madori::hmi
