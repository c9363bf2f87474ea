#include "hmi/server/site_editor.hpp"

#include <sodium.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/result.hpp"
#include "hmi/server/site_files.hpp"
#include "hmi/server/wire.hpp"
#include "mapping/drawing/drawing_picture.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site.hpp"
#include "mapping/site/site_file.hpp"
#include "mapping/site/site_transaction.hpp"
#include "mapping/wall_map/wall_files.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kScreenPx = 3000;

/// Text that stands in one line of YAML.
std::string one_line(std::string text) {
  std::erase_if(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == '"' || c == '\\'; });
  return text;
}

json vehicle_json(const mapping::VehicleRecord& v) {
  json wire;
  for (const auto& field : mapping::kVehicleFields) wire[field.name] = v.*field.value;
  return wire;
}

json sensors_json(const std::vector<mapping::SensorRecord>& sensors) {
  json list = json::array();
  for (const auto& s : sensors) list.push_back(to_wire(s));
  return list;
}

mapping::VehicleRecord vehicle_from(const json& wire) {
  mapping::VehicleRecord v;
  for (const auto& field : mapping::kVehicleFields) v.*field.value = wire.at(field.name).get<double>();
  return v;
}

/// What the panel does not show of a sensor stays as it was in the site.
std::vector<mapping::SensorRecord> sensors_from(const json& wire,
                                                const std::vector<mapping::SensorRecord>& before) {
  std::vector<mapping::SensorRecord> sensors;
  for (const auto& s : wire) {
    sensors.push_back({one_line(s.at("name").get<std::string>()), one_line(s.at("type").get<std::string>()),
                       s.at("x_m").get<double>(), s.at("y_m").get<double>(), s.at("z_m").get<double>(),
                       s.at("yaw_deg").get<double>()});
    for (const auto& old : before)
      if (old.name == sensors.back().name && old.type == sensors.back().type) {
        sensors.back().protective_m = old.protective_m;
        sensors.back().address = old.address;
        sensors.back().settings = old.settings;
      }
    if (const auto address = s.find("address"); address != s.end())
      sensors.back().address = one_line(address->get<std::string>());
  }
  return sensors;
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
            {"vehicle", vehicle_json({})},
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
  wire["vehicle"] = vehicle_json(site.vehicle);
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
  const fs::path staged = change.staged("site.yaml");
  mapping::write_new_file(staged, mapping::site_yaml(site));
  (void)mapping::read_site_file(staged);  // refuses values out of range, with the reason
  change.commit();
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
