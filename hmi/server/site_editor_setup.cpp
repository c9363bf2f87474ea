#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "hmi/server/site_editor.hpp"
#include "hmi/server/site_files.hpp"
#include "hmi/server/wire.hpp"
#include "mapping/site/site.hpp"
#include "planning/route_graph/route_csv.hpp"

namespace madori::hmi {
namespace {

using nlohmann::json;

constexpr const char* kFaultyLegs = "routes-through-wall";

json step(const char* name, const Notice& missing) {
  const bool done =
      missing.code.empty() || missing.code == kFaultyLegs;  // it can be driven, as far as it goes
  return {{"name", name}, {"done", done}, {"what", to_wire(missing)}};
}

Notice what_routes_miss(const std::filesystem::path& folder) {
  std::error_code missing;
  if (!std::filesystem::exists(folder / "routes/tree.csv", missing))
    return {"no-routes", {}, "Draw the routes, or import tree.csv and path.csv."};
  const auto parsed = planning::read_routes(folder / "routes");
  if (!parsed.good()) {
    const std::string first = parsed.findings.empty() ? "" : parsed.findings.front().text();
    return {"faulty-routes", {{"finding", first}}, "The routes cannot be read: " + first};
  }
  for (const auto& finding : findings_of(folder, parsed.graph))
    if (finding.severity == planning::Severity::Error)
      return {kFaultyLegs, {{"finding", finding.text()}}, finding.text()};
  if (parsed.graph.nodes().size() < 2)
    return {"few-routes", {}, "The routes need at least two points and a line between them."};
  return {};
}

Notice what_vehicle_misses(const mapping::Site& site) {
  if (!site.sensors.empty()) return {};
  return {"no-lidar", {}, "Enter a lidar and its place on the vehicle."};
}

Notice what_place_misses(const PoseEstimate& pose) {
  switch (pose.health.state) {
    case LocalizationState::Localized:
    case LocalizationState::Degraded:
      return {};
    case LocalizationState::Ambiguous:
      return {"place-ambiguous", {}, "The vehicle may be in more than one place: choose it."};
    case LocalizationState::Lost:
      break;
  }
  return {"place-unknown", {}, "It is not known yet where the vehicle stands."};
}

}  // namespace

json SiteEditor::setup_steps(const PoseEstimate& pose) const {
  const std::scoped_lock lock(mutex_);
  const Notice drawing =
      has_site(folder_) ? Notice{} : Notice{"no-drawing", {}, "Choose the factory's layout drawing."};
  Notice scale{"no-scale", {}, "Tell the scale: measure one length, or lay the drawing over a photograph."};
  Notice vehicle{"no-lidar", {}, "Enter a lidar and its place on the vehicle."};
  if (drawing.code.empty()) {
    const mapping::Site site = mapping::load_site(folder_);
    if (site.scale) scale = {};
    vehicle = what_vehicle_misses(site);
  }
  return {step("drawing", drawing), step("scale", scale), step("routes", what_routes_miss(folder_)),
          step("vehicle", vehicle), step("locate", what_place_misses(pose))};
}

}  // namespace madori::hmi
