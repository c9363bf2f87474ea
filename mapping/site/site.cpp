#include "mapping/site/site.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "core/result.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site_file.hpp"
#include "mapping/site/site_transaction.hpp"
#include "mapping/site/strict_yaml.hpp"

namespace madori::mapping {
namespace {

constexpr int kFormat = 1;
constexpr int kMaxSide = 1'000'000;

/// Not a path: what it leads to would be read, and removed by an import, outside the site.
bool is_name_in_folder(const std::string& name) {
  const bool printable =
      std::ranges::none_of(name, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
  return printable && !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos;
}

DrawingRecord read_drawing(StrictYaml yaml) {
  DrawingRecord record;
  record.file = yaml.text("file");
  if (!is_name_in_folder(record.file))
    throw yaml.error("file", "\"" + record.file + "\" is no name of a file in the site's folder",
                     "write the name alone, e.g. drawing.png");
  record.width_px = yaml.integer("width_px", 1, kMaxSide);
  record.height_px = yaml.integer("height_px", 1, kMaxSide);
  record.page = yaml.integer_or("page", record.page, 1, 100'000);
  record.dpi = yaml.number_or("dpi", record.dpi, 0.0, 100'000.0);
  yaml.refuse_unknown_keys();
  return record;
}

ScaleRecord read_scale(StrictYaml yaml) {
  ScaleRecord record;
  record.m_per_px = yaml.number("m_per_px", 1e-9, 1e6);
  record.method = yaml.text("method");
  record.relative_uncertainty = yaml.number_or("relative_uncertainty", 0.0, 0.0, 1.0);
  record.residual_m = yaml.number_or("residual_m", 0.0, 0.0, 1e6);
  record.date = yaml.text_or("date", "");
  record.inputs = yaml.texts("inputs");
  record.residuals_m = yaml.numbers("residuals_m");
  yaml.refuse_unknown_keys();
  return record;
}

GeoreferenceRecord read_georeference(StrictYaml yaml) {
  GeoreferenceRecord record;
  record.latitude_deg = yaml.number("latitude_deg", -90.0, 90.0);
  record.longitude_deg = yaml.number("longitude_deg", -180.0, 180.0);
  record.enu_from_map_yaw_deg = yaml.number("enu_from_map_yaw_deg", -360.0, 360.0);
  yaml.refuse_unknown_keys();
  return record;
}

VehicleRecord read_vehicle(StrictYaml yaml) {
  VehicleRecord r;
  for (const VehicleField& field : kVehicleFields)
    r.*field.value = yaml.number_or(field.name, r.*field.value, field.least, field.most);
  if (r.base_to_rear_m > r.length_m)
    throw yaml.error("base_to_rear_m", "the axle lies before the vehicle's front",
                     "measure from the driven axle to the rear bumper; at most length_m");
  constexpr double kFastestRadps = 100.0;  // that a command of the drive link holds
  const double rim_mps = r.max_speed_mps + r.max_turn_rate_radps * r.half_wheel_separation_m;
  if (rim_mps > kFastestRadps * r.wheel_radius_m)
    throw yaml.error("wheel_radius_m",
                     "so small a wheel would turn faster than " + std::to_string(std::lround(kFastestRadps)) +
                         " rad/s at max_speed_mps, which no command can say",
                     "correct it, or lower max_speed_mps");
  yaml.refuse_unknown_keys();
  return r;
}

bool read_route_metric(StrictYaml& yaml) {
  const std::string metric = yaml.text_or("route_metric", "hops");
  if (metric != "hops" && metric != "metres")
    throw yaml.error("route_metric", "\"" + metric + "\" is no way to choose a route",
                     "hops (fewest legs) or metres (shortest way)");
  return metric == "metres";
}

SensorRecord read_sensor(StrictYaml& yaml) {
  SensorRecord record;
  record.name = yaml.text("name");
  record.type = yaml.text("type");
  if (record.type.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") != std::string::npos)
    throw yaml.error("type", "\"" + record.type + "\" is no kind of sensor", "use small letters and digits");
  record.x_m = yaml.number_or("x_m", 0.0, -20.0, 20.0);
  record.y_m = yaml.number_or("y_m", 0.0, -20.0, 20.0);
  record.z_m = yaml.number_or("z_m", 0.0, -5.0, 20.0);
  record.yaw_deg = yaml.number_or("yaw_deg", 0.0, -360.0, 360.0);
  record.protective_m = yaml.number_or("protective_m", 0.0, 0.0, 5.0);
  record.protective_side_m = yaml.number_or("protective_side_m", 0.0, 0.0, 5.0);
  record.address = yaml.text_or("address", "");
  record.settings = yaml.pairs("settings");
  yaml.refuse_unknown_keys();
  return record;
}

void emit_scale(YAML::Emitter& out, const ScaleRecord& scale) {
  out << YAML::Key << "scale" << YAML::Value << YAML::BeginMap;
  out << YAML::Key << "m_per_px" << YAML::Value << scale.m_per_px;
  out << YAML::Key << "method" << YAML::Value << scale.method;
  out << YAML::Key << "relative_uncertainty" << YAML::Value << scale.relative_uncertainty;
  out << YAML::Key << "residual_m" << YAML::Value << scale.residual_m;
  out << YAML::Key << "date" << YAML::Value << scale.date;
  out << YAML::Key << "inputs" << YAML::Value << scale.inputs;
  if (!scale.residuals_m.empty())
    out << YAML::Key << "residuals_m" << YAML::Value << YAML::Flow << scale.residuals_m;
  out << YAML::EndMap;
}

void emit_vehicle(YAML::Emitter& out, const VehicleRecord& v) {
  out << YAML::Key << "vehicle" << YAML::Value << YAML::BeginMap;
  for (const VehicleField& field : kVehicleFields)
    out << YAML::Key << field.name << YAML::Value << v.*field.value;
  out << YAML::EndMap;
}

void emit_sensor(YAML::Emitter& out, const SensorRecord& s) {
  out << YAML::BeginMap << YAML::Key << "name" << YAML::Value << s.name;
  out << YAML::Key << "type" << YAML::Value << s.type;
  out << YAML::Key << "x_m" << YAML::Value << s.x_m << YAML::Key << "y_m" << YAML::Value << s.y_m;
  out << YAML::Key << "z_m" << YAML::Value << s.z_m << YAML::Key << "yaw_deg" << YAML::Value << s.yaw_deg;
  if (s.protective_m > 0.0) out << YAML::Key << "protective_m" << YAML::Value << s.protective_m;
  if (s.protective_side_m > 0.0)
    out << YAML::Key << "protective_side_m" << YAML::Value << s.protective_side_m;
  if (!s.address.empty()) out << YAML::Key << "address" << YAML::Value << s.address;
  if (!s.settings.empty()) out << YAML::Key << "settings" << YAML::Value << YAML::Flow << s.settings;
  out << YAML::EndMap;
}

}  // namespace

Site load_site(const std::filesystem::path& folder) {
  recover_site(folder);
  const auto file = folder / "site.yaml";
  if (!std::filesystem::exists(file))
    throw Error(folder.string(), "is no site folder (no site.yaml)",
                "make one: madori import DRAWING --site " + folder.string());
  return read_site_file(file);
}

Site read_site_file(const std::filesystem::path& file) {
  StrictYaml yaml = StrictYaml::load(file);
  yaml.integer("madori_site", kFormat, kFormat);
  Site site;
  site.name = yaml.text("name");
  site.drawing = read_drawing(yaml.section("drawing"));
  if (yaml.has("scale")) {
    site.scale = read_scale(yaml.section("scale"));
    require_possible_size(file.string() + ": scale.m_per_px", site.drawing, site.scale->m_per_px);
  }
  if (yaml.has("georeference")) site.georeference = read_georeference(yaml.section("georeference"));
  if (yaml.has("vehicle")) site.vehicle = read_vehicle(yaml.section("vehicle"));
  for (StrictYaml& sensor : yaml.list("sensors")) site.sensors.push_back(read_sensor(sensor));
  site.shortest_routes = read_route_metric(yaml);
  site.camera = yaml.text_or("camera", "");
  site.low_bodies_guarded_by = yaml.text_or("low_bodies_guarded_by", "");
  yaml.refuse_unknown_keys();
  return site;
}

Site load_scaled_site(const std::filesystem::path& folder) {
  Site site = load_site(folder);
  if (!site.scale)
    throw Error(
        folder.string(), "the drawing has no scale yet, so nothing may drive on it",
        "measure one length: madori scale " + folder.string() + " --known u1,v1,u2,v2=METRES --apply");
  return site;
}

void require_possible_size(const std::string& where, const DrawingRecord& drawing, double m_per_px) {
  constexpr double kShortest_m = 1.0;
  constexpr double kLongest_m = 10'000.0;
  const double side_m = m_per_px * std::max(drawing.width_px, drawing.height_px);
  if (side_m >= kShortest_m && side_m <= kLongest_m) return;
  std::ostringstream what;
  what << "at " << m_per_px << " m/px the drawing would be " << side_m << " m long, which no building is";
  throw Error(where, what.str(), "check the measured length and its unit (metres)");
}

std::string site_yaml(const Site& site) {
  YAML::Emitter out;
  out.SetDoublePrecision(std::numeric_limits<double>::max_digits10);
  out << YAML::BeginMap << YAML::Key << "madori_site" << YAML::Value << kFormat;
  out << YAML::Key << "name" << YAML::Value << site.name;
  const DrawingRecord& drawing = site.drawing;
  out << YAML::Key << "drawing" << YAML::Value << YAML::BeginMap;
  out << YAML::Key << "file" << YAML::Value << drawing.file;
  out << YAML::Key << "width_px" << YAML::Value << drawing.width_px;
  out << YAML::Key << "height_px" << YAML::Value << drawing.height_px;
  out << YAML::Key << "page" << YAML::Value << drawing.page;
  out << YAML::Key << "dpi" << YAML::Value << drawing.dpi << YAML::EndMap;
  if (site.scale) emit_scale(out, *site.scale);
  if (site.georeference) {
    out << YAML::Key << "georeference" << YAML::Value << YAML::BeginMap;
    out << YAML::Key << "latitude_deg" << YAML::Value << site.georeference->latitude_deg;
    out << YAML::Key << "longitude_deg" << YAML::Value << site.georeference->longitude_deg;
    out << YAML::Key << "enu_from_map_yaw_deg" << YAML::Value << site.georeference->enu_from_map_yaw_deg;
    out << YAML::EndMap;
  }
  emit_vehicle(out, site.vehicle);
  if (site.shortest_routes) out << YAML::Key << "route_metric" << YAML::Value << "metres";
  if (!site.sensors.empty()) {
    out << YAML::Key << "sensors" << YAML::Value << YAML::BeginSeq;
    for (const SensorRecord& sensor : site.sensors) emit_sensor(out, sensor);
    out << YAML::EndSeq;
  }
  if (!site.camera.empty()) out << YAML::Key << "camera" << YAML::Value << site.camera;
  if (!site.low_bodies_guarded_by.empty())
    out << YAML::Key << "low_bodies_guarded_by" << YAML::Value << site.low_bodies_guarded_by;
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

void save_site(const std::filesystem::path& folder, const Site& site) {
  write_file_atomically(folder / "site.yaml", site_yaml(site));
}

}  // namespace madori::mapping
