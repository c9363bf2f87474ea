#include "hmi/server/site_editor.hpp"

#include <sodium.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/result.hpp"
#include "hmi/server/site_files.hpp"
#include "hmi/server/vehicle_wire.hpp"
#include "hmi/server/wire.hpp"
#include "mapping/drawing/drawing_picture.hpp"
#include "mapping/site/site.hpp"
#include "mapping/site/site_transaction.hpp"
#include "mapping/wall_map/wall_files.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kScreenPx = 3000;

json sensors_json(const std::vector<mapping::SensorRecord>& sensors) {
  json list = json::array();
  for (const auto& s : sensors) list.push_back(to_wire(s));
  return list;
}

}  // namespace

SiteEditor::SiteEditor(fs::path folder) : folder_(std::move(folder)), watch_(folder_) {
  if (sodium_init() < 0) throw Error("libsodium", "cannot be started", "reinstall the package libsodium23");
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
            {"vehicle", to_wire(mapping::VehicleRecord{})},
            {"sensors", json::array()},
            {"route_metric", "hops"},
            {"attribution", attribution_of(folder_ / "tiles")},
            {"walls_revision", walls_revision(folder_)},
            {"routes_revision", routes_revision(folder_)},
            {"vehicle_revision", vehicle_revision(folder_)}};
  if (!has_site(folder_)) return wire;
  const mapping::Site site = mapping::load_site(folder_);
  wire["name"] = site.name;
  wire["drawing"] = {{"file", site.drawing.file},
                     {"width_px", site.drawing.width_px},
                     {"height_px", site.drawing.height_px}};
  wire["vehicle"] = to_wire(site.vehicle);
  wire["sensors"] = sensors_json(site.sensors);
  wire["route_metric"] = site.shortest_routes ? "metres" : "hops";
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
  return {{"revision", walls_revision(folder_)}, {"walls", list}};
}

json SiteEditor::save_walls(const json& edit) {
  const std::scoped_lock lock(mutex_);
  require_revision(edit, walls_revision(folder_));
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
  return {{"revision", walls_revision(folder_)}};
}

json SiteEditor::revisions() const {
  const SiteRevisions now = watch_.now();
  return {{"drawing", now.drawing}, {"walls", now.walls}, {"routes", now.routes}, {"vehicle", now.vehicle}};
}

json SiteEditor::save_vehicle(const json& edit) {
  const std::scoped_lock lock(mutex_);
  if (!has_site(folder_)) throw Error(folder_.string(), "has no drawing yet", "choose one in the first step");
  require_revision(edit, vehicle_revision(folder_));
  mapping::Site site = mapping::load_site(folder_);
  site.vehicle = vehicle_from(edit.at("vehicle"));
  site.sensors = sensors_from(edit.at("sensors"), site.sensors);
  site.shortest_routes = edit.at("route_metric") == "metres";
  mapping::SiteTransaction change(folder_);
  change.write("site.yaml", mapping::site_yaml(site));
  change.commit();  // refuses values out of range, with the reason
  return {{"revision", vehicle_revision(folder_)}};
}

/// The mutex of the files is not held while the picture is drawn: that takes seconds.
std::string SiteEditor::drawing_png() {
  const std::scoped_lock picture(picture_mutex_);
  std::string revision;
  mapping::Site site;
  {
    const std::scoped_lock lock(mutex_);
    if (!has_site(folder_)) throw Error(folder_.string(), "has no drawing yet", "choose one in step 1");
    revision = drawing_revision(folder_);
    site = mapping::load_site(folder_);
  }
  if (revision != drawing_of_) {
    const auto png = mapping::drawing_picture(folder_, site, kScreenPx);
    drawing_.assign(png.begin(), png.end());
    drawing_of_ = revision;
  }
  return drawing_;
}

}  // namespace madori::hmi
