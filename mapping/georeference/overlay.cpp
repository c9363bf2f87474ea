#include "mapping/georeference/overlay.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <sstream>

#include "core/angle.hpp"
#include "core/result.hpp"
#include "core/transform2.hpp"
#include "mapping/georeference/local_plane.hpp"
#include "mapping/georeference/number_list.hpp"

namespace madori::mapping {
namespace {

/// By eye; the published example was 5 m off in 74 m (6.8 %).
constexpr double kByEye = 0.05;
constexpr const char* kUsage =
    "write zoom=18,lat=35.464478,lon=136.739235,layout=3.3,photo=1.67, and where you turned or shifted the "
    "drawing ,rotation_deg=..,east_m=..,north_m=..,u=..,v=..";

using Values = std::map<std::string, double>;

Values read_values(const std::string& text) {
  Values values;
  std::istringstream fields(text);
  std::string field;
  while (std::getline(fields, field, ',')) {
    const std::size_t equals = field.find('=');
    const auto number = equals == std::string::npos
                            ? std::nullopt
                            : parse_numbers(std::string_view(field).substr(equals + 1));
    if (!number || !values.emplace(field.substr(0, equals), number->front()).second)
      throw Error("--overlay", "\"" + field + "\" is no key=number, or stands twice", kUsage);
  }
  return values;
}

double take(Values& values, const std::string& key, std::optional<double> fallback, double low, double high) {
  const auto at = values.find(key);
  if (at == values.end() && !fallback) throw Error("--overlay", key + " is missing", kUsage);
  const double value = at == values.end() ? *fallback : at->second;
  if (at != values.end()) values.erase(at);
  if (!(value >= low && value <= high))
    throw Error("--overlay", fmt::format("{} must lie between {:g} and {:g}", key, low, high), kUsage);
  return value;
}

Point2<Map> anchor_of(const Overlay& o, double m_per_px, int width_px, int height_px) {
  return {o.u.value_or(width_px / 2.0) * m_per_px, (height_px - o.v.value_or(height_px / 2.0)) * m_per_px};
}

/// The Map origin lies where the anchor says, turned by the rotation.
GeoreferenceRecord georeference_of(const Overlay& o, const Point2<Map>& anchor) {
  const Transform2<Enu, Map> turn(0.0, 0.0, to_rad(o.rotation_deg));
  const Point2<Enu> turned = turn * anchor;
  const LatLon origin = LocalPlane(o.place).place_of({o.east_m - turned.x_m, o.north_m - turned.y_m});
  return {origin.latitude_deg, origin.longitude_deg, o.rotation_deg};
}

}  // namespace

Overlay parse_overlay(const std::string& text) {
  Values values = read_values(text);
  Overlay o;
  for (const char* key : {"rotation_deg", "east_m", "north_m", "u", "v"})
    o.placed = o.placed || values.contains(key);
  const double zoom = take(values, "zoom", {}, 0.0, kMaxZoom);
  if (zoom != std::floor(zoom)) throw Error("--overlay", "zoom is no whole number", kUsage);
  o.zoom = static_cast<int>(zoom);
  o.place.latitude_deg = take(values, "lat", {}, -kMaxLatitudeDeg, kMaxLatitudeDeg);
  o.place.longitude_deg = take(values, "lon", {}, -180.0, 180.0);
  o.layout_zoom = take(values, "layout", {}, 1e-6, 1e6);
  o.photo_zoom = take(values, "photo", {}, 1e-6, 1e6);
  o.tile_pixels = take(values, "tile", kTilePixels, 1.0, 8192.0);
  o.rotation_deg = take(values, "rotation_deg", 0.0, -360.0, 360.0);
  o.east_m = take(values, "east_m", 0.0, -1e5, 1e5);
  o.north_m = take(values, "north_m", 0.0, -1e5, 1e5);
  if (values.contains("u")) o.u = take(values, "u", {}, -1e6, 1e6);
  if (values.contains("v")) o.v = take(values, "v", {}, -1e6, 1e6);
  if (!values.empty()) throw Error("--overlay", values.begin()->first + " is not known", kUsage);
  return o;
}

ScaleEstimate fit_overlay(const Overlay& o, int width_px, int height_px) {
  ScaleEstimate e;
  e.method = "overlay";
  const double side = tile_side_m(o.place.latitude_deg, o.zoom);
  e.m_per_px = overlay_scale(side, o.tile_pixels, o.photo_zoom, o.layout_zoom);
  e.relative_uncertainty = kByEye;
  e.inputs = {fmt::format("zoom={},lat={:.10g},lon={:.10g},layout={:g},photo={:g},tile={:g}", o.zoom,
                          o.place.latitude_deg, o.place.longitude_deg, o.layout_zoom, o.photo_zoom,
                          o.tile_pixels)};
  if (o.placed) {
    e.held = anchor_of(o, e.m_per_px, width_px, height_px);
    e.georeference = georeference_of(o, e.held);
    e.inputs.front() +=
        fmt::format(",rotation_deg={:g},east_m={:g},north_m={:g},u={:g},v={:g}", o.rotation_deg, o.east_m,
                    o.north_m, o.u.value_or(width_px / 2.0), o.v.value_or(height_px / 2.0));
  }
  const TileSides sides = ellipsoid_tile_sides(o.place, o.zoom);
  const auto metres = [](double m) { return fmt::format("{:.2f}", m); };
  e.notes.push_back(
      {"scale-tile",
       {{"tile", metres(side)}, {"east", metres(sides.east_m)}, {"north", metres(sides.north_m)}},
       fmt::format("a tile is {:.2f} m here; on the ellipsoid {:.2f} m east, {:.2f} m north", side,
                   sides.east_m, sides.north_m)});
  e.notes.push_back(
      {"scale-by-eye", {}, "laid over a photograph by eye: check it with a measured length (--known)"});
  judge(e);
  return e;
}

}  // namespace madori::mapping
