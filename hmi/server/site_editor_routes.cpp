#include <nlohmann/json.hpp>
#include <utility>

#include "core/result.hpp"
#include "hmi/server/route_wire.hpp"
#include "hmi/server/site_editor.hpp"
#include "hmi/server/site_files.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site.hpp"
#include "mapping/site/site_transaction.hpp"
#include "planning/route_graph/route_check.hpp"

namespace madori::hmi {
namespace fs = std::filesystem;
using nlohmann::json;

json SiteEditor::routes() const {
  const std::scoped_lock lock(mutex_);
  if (!fs::exists(folder_ / "routes/tree.csv")) return routes_to_wire({}, {}, routes_revision(folder_));
  const planning::ParsedRoutes parsed = planning::read_routes(folder_ / "routes");
  auto findings = parsed.findings;
  if (parsed.good())
    for (auto& f : findings_of(folder_, parsed.graph)) findings.push_back(std::move(f));
  return routes_to_wire(parsed.graph, findings, routes_revision(folder_));
}

json SiteEditor::check_routes(const json& edit) const {
  const planning::RouteGraph graph = graph_from_wire(edit);
  const std::scoped_lock lock(mutex_);
  return routes_to_wire(graph, findings_of(folder_, graph), routes_revision(folder_));
}

json SiteEditor::teach_routes(const json& edit, const std::vector<planning::DrivenPose>& way) const {
  constexpr double kLeast_m = 1.0;
  if (planning::length_m(way) < kLeast_m)
    throw Error("the way driven", "is shorter than a metre",
                "drive by hand where the route shall be, then teach it");
  const planning::RouteGraph graph = planning::taught(graph_from_wire(edit), way);
  const std::scoped_lock lock(mutex_);
  return routes_to_wire(graph, findings_of(folder_, graph), routes_revision(folder_));
}

/// The answer holds what was checked, so that the page need not ask again.
json SiteEditor::save_routes(const json& edit) {
  const planning::RouteGraph graph = graph_from_wire(edit);
  const std::scoped_lock lock(mutex_);
  require_revision(edit, routes_revision(folder_));
  mapping::SiteTransaction change(folder_);
  change.write("routes/tree.csv", planning::tree_csv(graph));
  change.write("routes/path.csv", planning::path_csv(graph));
  change.commit();
  return routes_to_wire(graph, findings_of(folder_, graph), routes_revision(folder_));
}

json SiteEditor::import_routes(const json& csv) {
  const auto tree = csv.at("tree").get<std::string>();
  const auto path = csv.at("path").get<std::string>();
  const planning::ParsedRoutes parsed = planning::parse_routes(tree, path);
  for (const auto& finding : parsed.findings)
    if (finding.severity == planning::Severity::Error)
      throw Error(finding.text(), "the routes were not imported", "mend that line");
  const std::scoped_lock lock(mutex_);
  if (!csv.at("revision").get<std::string>().empty()) require_revision(csv, routes_revision(folder_));
  mapping::SiteTransaction change(folder_);
  change.write("routes/tree.csv", tree);
  change.write("routes/path.csv", path);
  change.commit();
  return routes_to_wire(parsed.graph, parsed.findings, routes_revision(folder_));
}

json SiteEditor::routes_csv() const {
  const std::scoped_lock lock(mutex_);
  return {{"revision", routes_revision(folder_)},
          {"tree", mapping::file_content(folder_ / "routes/tree.csv")},
          {"path", mapping::file_content(folder_ / "routes/path.csv")}};
}

std::string SiteEditor::routes_file(const std::string& name) const {
  const std::scoped_lock lock(mutex_);
  if (!fs::exists(folder_ / "routes" / name))
    throw Error(name, "is not there yet", "draw a route and save it");
  return mapping::file_content(folder_ / "routes" / name);
}

}  // namespace madori::hmi
