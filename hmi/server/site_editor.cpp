#include "hmi/server/site_editor.hpp"

#include <sodium.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/result.hpp"
#include "hmi/server/route_wire.hpp"
#include "mapping/drawing/drawing_picture.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site.hpp"
#include "mapping/site/site_transaction.hpp"
#include "mapping/wall_map/wall_files.hpp"
#include "planning/route_graph/route_check.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kScreenPx = 3000;

/// A short name of what some files hold.
std::string hash_of(std::initializer_list<fs::path> files) {
  crypto_generichash_state state;
  crypto_generichash_init(&state, nullptr, 0, 16);
  for (const auto& file : files) {
    const std::string content = mapping::file_content(file) + '\0';
    crypto_generichash_update(&state, reinterpret_cast<const unsigned char*>(content.data()), content.size());
  }
  std::array<unsigned char, 16> hash{};
  crypto_generichash_final(&state, hash.data(), hash.size());
  std::array<char, 33> text{};
  sodium_bin2hex(text.data(), text.size(), hash.data(), hash.size());
  return text.data();
}

bool has_site(const fs::path& folder) {
  return fs::exists(folder / "site.yaml");
}

json vehicle_json(const mapping::VehicleRecord& v) {
  return {{"length_m", v.length_m},
          {"width_m", v.width_m},
          {"base_to_rear_m", v.base_to_rear_m},
          {"max_speed_mps", v.max_speed_mps}};
}

json sensors_json(const std::vector<mapping::SensorRecord>& sensors) {
  json list = json::array();
  for (const auto& s : sensors)
    list.push_back({{"name", s.name},
                    {"type", s.type},
                    {"x_m", s.x_m},
                    {"y_m", s.y_m},
                    {"z_m", s.z_m},
                    {"yaw_deg", s.yaw_deg}});
  return list;
}

std::vector<Segment2<Map>> drawn_walls(const fs::path& folder) {
  std::vector<Segment2<Map>> walls;
  if (!has_site(folder)) return walls;
  for (const auto& wall : mapping::load_walls(folder / "walls.csv")) walls.push_back(wall.segment);
  return walls;
}

std::vector<planning::RouteFinding> findings_of(const fs::path& folder, const planning::RouteGraph& graph) {
  planning::RouteCheckOptions options;
  if (has_site(folder)) options.half_width_m = mapping::load_site(folder).vehicle.width_m / 2.0;
  return planning::check_routes(graph, drawn_walls(folder), options);
}

}  // namespace

SiteEditor::SiteEditor(fs::path folder) : folder_(std::move(folder)) {
  if (sodium_init() < 0) throw Error("libsodium", "cannot be started", "reinstall the package libsodium23");
}

std::string SiteEditor::walls_revision() const {
  return hash_of({folder_ / "site.yaml", folder_ / "walls.csv"});
}
std::string SiteEditor::routes_revision() const {
  return hash_of({folder_ / "routes/tree.csv", folder_ / "routes/path.csv"});
}

void SiteEditor::require_revision(const json& edit, const std::string& newest) const {
  if (edit.at("revision").get<std::string>() != newest) throw Conflict();
}

json SiteEditor::site() const {
  const std::scoped_lock lock(mutex_);
  json wire{{"name", folder_.filename().string()},
            {"drawing", nullptr},
            {"scale", nullptr},
            {"georeference", nullptr},
            {"vehicle", vehicle_json({})},
            {"sensors", json::array()},
            {"walls_revision", walls_revision()},
            {"routes_revision", routes_revision()}};
  if (!has_site(folder_)) return wire;
  const mapping::Site site = mapping::load_site(folder_);
  wire["name"] = site.name;
  wire["drawing"] = {{"file", site.drawing.file},
                     {"width_px", site.drawing.width_px},
                     {"height_px", site.drawing.height_px}};
  wire["vehicle"] = vehicle_json(site.vehicle);
  wire["sensors"] = sensors_json(site.sensors);
  if (const auto& s = site.scale)
    wire["scale"] = {{"m_per_px", s->m_per_px},
                     {"method", s->method},
                     {"relative_uncertainty", s->relative_uncertainty},
                     {"residual_m", s->residual_m},
                     {"date", s->date}};
  if (const auto& g = site.georeference)
    wire["georeference"] = {{"latitude_deg", g->latitude_deg},
                            {"longitude_deg", g->longitude_deg},
                            {"enu_from_map_yaw_deg", g->enu_from_map_yaw_deg}};
  return wire;
}

json SiteEditor::walls() const {
  const std::scoped_lock lock(mutex_);
  json list = json::array();
  for (const auto& w : drawn_walls(folder_)) list.push_back({w.a.x_m, w.a.y_m, w.b.x_m, w.b.y_m, -1.0});
  return {{"revision", walls_revision()}, {"walls", list}};
}

json SiteEditor::save_walls(const json& edit) {
  const std::scoped_lock lock(mutex_);
  require_revision(edit, walls_revision());
  const mapping::Site site = mapping::load_site(folder_);
  mapping::Walls walls;
  for (const auto& w : edit.at("walls")) {
    const Segment2<Map> segment{{w.at(0).get<double>(), w.at(1).get<double>()},
                                {w.at(2).get<double>(), w.at(3).get<double>()}};
    if (!std::isfinite(segment.length_m()))
      throw Error("walls", "hold a number that is not finite", "draw the wall again");
    walls.push_back({static_cast<int>(walls.size()) + 1, segment});
  }
  if (walls.empty())
    throw Error("walls", "must not all be erased", "keep at least one, or import the drawing again");
  mapping::SiteTransaction change(folder_);
  const double unit = site.scale ? site.scale->m_per_px : 1.0;
  (void)mapping::stage_wall_files(
      change, walls, site.drawing.width_px * unit, site.drawing.height_px * unit,
      site.scale ? mapping::WallFileOptions{} : mapping::WallFileOptions::unscaled());
  change.commit();
  return {{"revision", walls_revision()}};
}

std::string SiteEditor::drawing_png() {
  const std::scoped_lock lock(mutex_);
  if (!has_site(folder_)) throw Error(folder_.string(), "has no drawing yet", "choose one in step 1");
  const std::string revision = hash_of({folder_ / "site.yaml"});
  if (revision != drawing_of_) {
    const auto png = mapping::drawing_picture(folder_, mapping::load_site(folder_), kScreenPx);
    drawing_.assign(png.begin(), png.end());
    drawing_of_ = revision;
  }
  return drawing_;
}

json SiteEditor::routes() const {
  const std::scoped_lock lock(mutex_);
  if (!fs::exists(folder_ / "routes/tree.csv")) return routes_to_wire({}, {}, routes_revision());
  const planning::ParsedRoutes parsed = planning::read_routes(folder_ / "routes");
  auto findings = parsed.findings;
  if (parsed.good())
    for (auto& f : findings_of(folder_, parsed.graph)) findings.push_back(std::move(f));
  return routes_to_wire(parsed.graph, findings, routes_revision());
}

json SiteEditor::check_routes(const json& edit) const {
  const planning::RouteGraph graph = graph_from_wire(edit);
  const std::scoped_lock lock(mutex_);
  return routes_to_wire(graph, findings_of(folder_, graph), routes_revision());
}

json SiteEditor::save_routes(const json& edit) {
  const planning::RouteGraph graph = graph_from_wire(edit);
  const std::scoped_lock lock(mutex_);
  require_revision(edit, routes_revision());
  mapping::SiteTransaction change(folder_);
  change.write("routes/tree.csv", planning::tree_csv(graph));
  change.write("routes/path.csv", planning::path_csv(graph));
  change.commit();
  return routes_to_wire(graph, findings_of(folder_, graph), routes_revision());
}

json SiteEditor::import_routes(const json& csv) {
  const auto tree = csv.at("tree").get<std::string>();
  const auto path = csv.at("path").get<std::string>();
  const planning::ParsedRoutes parsed = planning::parse_routes(tree, path);
  for (const auto& finding : parsed.findings)
    if (finding.severity == planning::Severity::Error)
      throw Error(finding.text(), "the routes were not imported", "mend that line");
  const std::scoped_lock lock(mutex_);
  mapping::SiteTransaction change(folder_);
  change.write("routes/tree.csv", tree);
  change.write("routes/path.csv", path);
  change.commit();
  return routes_to_wire(parsed.graph, parsed.findings, routes_revision());
}

std::string SiteEditor::routes_file(const std::string& name) const {
  const std::scoped_lock lock(mutex_);
  if (!fs::exists(folder_ / "routes" / name))
    throw Error(name, "is not there yet", "draw a route and save it");
  return mapping::file_content(folder_ / "routes" / name);
}

}  // namespace madori::hmi
