#include <charconv>

#include "core/result.hpp"
#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"
#include "hmi/server/site_compare.hpp"
#include "mapping/site/site_versions.hpp"

namespace madori::hmi {
namespace {

int version_of(const Request& request, std::size_t capture) {
  const std::string& text = request.captures.at(capture);
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size())
    throw Error("version " + text, "is no number of a version", "reload the page");
  return number;
}

}  // namespace

void add_version_routes(Router& router, ApiContext& context) {
  const std::filesystem::path folder = context.editor.folder();
  router.add("GET", "/api/site/versions", Role::Viewer,
             answering([folder](const Request&) { return versions_json(folder); }), Work::Worker);
  router.add("GET", "/api/site/versions/*/against/*", Role::Viewer, answering([folder](const Request& r) {
               return compare_versions(folder, version_of(r, 0), version_of(r, 1));
             }),
             Work::Worker);
  router.add("POST", "/api/site/versions/*/restore", Role::Integrator,
             changing(context.vehicle,
                      [folder](const Request& r) {
                        mapping::restore_version(folder, version_of(r, 0));
                        return nlohmann::json::object();
                      }),
             Work::Worker);
}

}  // namespace madori::hmi
